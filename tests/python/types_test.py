"""The types of the package hold together, and those of a program that uses it."""

import importlib.util
import subprocess
import sys
import tempfile
import unittest

from python_support import ROOT, PythonTest

PROGRAM = """import sinew

sim = sinew.Simulation("liver.toml", set={"liver.young": 5e3})
force: float = float(sim.obstacle("tool").force[0])
result: sinew.RunResult = sinew.run("liver.toml", out="o")
name: str = result.status
"""


@unittest.skipIf(importlib.util.find_spec("mypy") is None, "mypy is not installed")
class TypesTest(PythonTest):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="sinew-mypy-")  # the types of numpy take long
        cls.addClassCleanup(folder.cleanup)
        cls.cache = folder.name

    def mypy(self, *args):
        return subprocess.run([sys.executable, "-m", "mypy", "--strict", "--no-error-summary",
                               "--cache-dir", self.cache, *args], cwd=ROOT / "python",
                              text=True, capture_output=True, check=False)

    def test_the_package(self):
        result = self.mypy("sinew")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_a_program(self):
        result = self.mypy(str(self.write("program.py", PROGRAM)))
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        wrong = PROGRAM.replace("name: str = result.status", "name: int = result.status")
        self.assertNotEqual(self.mypy(str(self.write("wrong.py", wrong))).returncode, 0)


if __name__ == "__main__":
    unittest.main()
