"""sinew study: the command of the shell."""

import json
import os
import signal
import subprocess
import time
import unittest

from python_support import BEAM, PythonTest

BIN = os.environ.get("SINEW_BIN", "sinew")
STUDY = """scene = "beam.toml"
[vary]
"beam.young" = { low = 50e3, high = 200e3, grid = 3 }
"beam.poisson" = [0.3, 0.45]
[set]
duration = 0.05
"""


class StudyCommandTest(PythonTest):
    def setUp(self):
        super().setUp()
        self.write("beam.toml", BEAM)
        self.write("study.toml", STUDY)

    def sinew(self, *args, code=0, **environment):
        result = subprocess.run([BIN, "study", *args], cwd=self.dir, text=True, capture_output=True,
                                timeout=200, check=False, env={**os.environ, **environment})
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def test_a_grid(self):
        result = self.sinew("study.toml", "--workers", "2")
        self.assertIn("6 of 6 runs finished: out/study/table.csv", result.stdout)
        self.assertIn("6 of 6 runs", result.stderr)
        self.assertIn("<h2>Runs</h2>", (self.dir / "out/study/report.html").read_text())
        rows = (self.dir / "out/study/table.csv").read_text().splitlines()
        self.assertEqual(len(rows), 7)
        answer = json.loads(self.sinew("study.toml", "--json", "--quiet").stdout)
        self.assertEqual((answer["runs"], answer["failed"]), (6, 0))

    def test_effects(self):
        self.write("m.toml", 'design = "morris"\ntrajectories = 2\n'
                   'result = "tip.uy"\n' + STUDY)
        answer = json.loads(self.sinew("m.toml", "--out", "m", "--json", "-q").stdout)
        self.assertEqual(set(answer["effects"]), {"beam.young", "beam.poisson"})

    def test_mistakes(self):
        for text, what in (("", "'scene' is missing"), ("scene = 1 2", "study"),
                           ('scene = "beam.toml"\nvary = 1\n', "expected a table"),
                           ('scene = "beam.toml"\n[vary]\n"beam.young" = 3\n', "no range"),
                           ('scenes = "a"\n', "unknown key 'scenes'"),
                           ('scene = "beam.toml"\n[vary]\n"beam.yuong" = [3.0]\n', "yuong")):
            self.write("bad.toml", text)
            result = self.sinew("bad.toml", code=3)
            self.assertIn(what, result.stderr)
            self.assertIn("remedy: ", result.stderr)
        for line, what in (('samples = "a"', "expected a whole number"), ("design = 5", "a text"),
                           ("seed = true", "a whole number"), ('fields = "yes"', "true or false")):
            self.write("bad.toml", f"{line}\n{STUDY}")
            self.assertIn(what, self.sinew("bad.toml", code=3).stderr)
        for line, what in (("samples = 10000000000", "1000000"), ("samples = 0", "1000000"),
                           ("seed = -1", "seed is -1")):
            self.write("bad.toml", f'design = "latin"\n{line}\n{STUDY}')
            self.assertIn(what, self.sinew("bad.toml", code=2).stderr)
        self.assertIn("cloud", self.sinew("study.toml", "--on", "cloud", code=2).stderr)

    def test_without_the_package(self):
        result = self.sinew("study.toml", code=2, SINEW_PYTHON="/nowhere/python3")
        self.assertIn("/nowhere/python3 does not find", result.stderr)
        self.assertIn("./dev python", result.stderr)

    def test_ctrl_c(self):
        self.write("long.toml", STUDY.replace("0.05", "300"))
        child = subprocess.Popen([BIN, "study", "long.toml", "--workers", "1"], cwd=self.dir,
                                 stderr=subprocess.PIPE, text=True, start_new_session=True)
        child.stderr.readline()
        time.sleep(1.5)
        os.killpg(child.pid, signal.SIGINT)
        error = child.communicate(timeout=60)[1]
        self.assertEqual(child.returncode, 130, error)
        self.assertIn("does the rest", error)


if __name__ == "__main__":
    unittest.main()
