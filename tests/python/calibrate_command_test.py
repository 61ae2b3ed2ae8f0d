"""sinew calibrate: the command of the shell."""

import importlib.util
import json
import os
import subprocess
import unittest

import numpy as np
from python_support import PythonTest, cube
from sinew.calibration.fit import _Curve

BIN = os.environ.get("SINEW_BIN", "sinew")
FIT = """scene = "cube.toml"
data = "curve.csv"
moved = "pin.plate"
direction = [0, -1, 0]
[parameters]
"cube.young" = { low = 1e3, high = 50e3, log = true }
"""


@unittest.skipIf(importlib.util.find_spec("scipy") is None, "scipy is not installed")
class CalibrateCommandTest(PythonTest):
    def setUp(self):
        super().setUp()
        self.write("cube.toml", cube(cells=2).toml())
        self.write("fit.toml", FIT)
        depth = np.linspace(0.2e-3, 2e-3, 6)
        force = _Curve(str(self.dir / "cube.toml"), "pin.plate", (0, -1, 0), [], depth).force(
            {"cube.young": 12e3})
        rows = "\n".join(f"{x},{f}" for x, f in zip(depth, force))
        self.write("curve.csv", f"displacement [m],force [N]\n{rows}\n")

    def sinew(self, *args, code=0):
        result = subprocess.run([BIN, "calibrate", *args], cwd=self.dir, text=True,
                                capture_output=True, timeout=200, check=False)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def test_a_fit(self):
        result = self.sinew("fit.toml")
        self.assertIn("cube.young: 12000", result.stdout)
        folder = self.dir / "out/fit"
        self.assertEqual(sorted(p.name for p in folder.iterdir()),
                         ["curve.csv", "report.html", "result.json"])
        self.assertEqual(len((folder / "curve.csv").read_text().splitlines()), 7)
        self.assertIn("<td>cube.young</td>", (folder / "report.html").read_text())
        again = json.loads(self.sinew("fit.toml", "--json", "--quiet").stdout)
        self.assertEqual(again["folder"], "out/fit-2")
        self.assertAlmostEqual(again["estimates"]["cube.young"]["value"] / 12e3, 1.0, places=3)
        self.assertIn("exists", self.sinew("fit.toml", "--out", "out/fit", code=2).stderr)

    def test_mistakes(self):
        for wrong, said in ((FIT.replace('data = "curve.csv"\n', ""), "the key 'data' is missing"),
                            (FIT.replace("moved", "move"), "unknown key 'move'"),
                            (FIT.replace("[0, -1, 0]", "[0, -1]"), "three numbers"),
                            (FIT.replace("low = 1e3", "low = 'a'"), "cube.young"),
                            (FIT.replace("= { low = 1e3, high = 50e3, log = true }", "= [1, 2]"),
                             "needs a range"),
                            (FIT.split("[parameters]")[0], "[parameters] is missing"),
                            (FIT.replace("log = true", "log = 3"), "no range"),
                            ("set = 4\n" + FIT, "a table"),
                            (FIT.replace('"pin.plate"', "7"), "a text"),
                            ("scene = ", "Invalid value")):
            self.write("wrong.toml", wrong)
            result = self.sinew("wrong.toml", code=3)
            self.assertIn(said, result.stderr)
            self.assertIn("remedy:", result.stderr)
        self.assertFalse((self.dir / "out").exists())


if __name__ == "__main__":
    unittest.main()
