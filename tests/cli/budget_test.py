"""tools/budget_run.py, short: the liver pulled at random with little time a frame. Times are not tested."""

import subprocess
import sys
import unittest

from cli_support import BIN, INPUT, ROOT, SCENES, CliTest


class BudgetTest(CliTest):
    def test_two_hundred_frames_stay_finite(self):
        r = subprocess.run([sys.executable, ROOT / "tools/budget_run.py", "--sinew", BIN,
                            "--frames", "200", "--budget", "1", "--out", self.dir / "run"],
                           text=True, capture_output=True, timeout=250)
        self.assertEqual(r.returncode, 0, r.stdout + r.stderr)
        self.assertIn("200 frames of ", r.stdout)
        self.assertIn("finished, 0 values not finite", r.stdout)
        rows = (self.dir / "run/energy.csv").read_text(encoding="utf-8").splitlines()
        header = rows[0].split(",")
        kinetic = [float(row.split(",")[header.index("kinetic [J]")]) for row in rows[1:]]
        self.assertLess(max(kinetic), 5.0)  # 1.8 kg at the hand's speed of half a metre a second

    def test_auto_says_what_it_takes(self):
        beam = SCENES / "beam.toml"
        r = self.run_sinew("run", beam, "--set", "stepper=auto", "--set", "duration=0.1",
                           "--no-output")
        self.assertRegex(r.stdout, 'stepper = "auto" takes (verlet|implicit) .verlet: stable step ')
        r = self.run_sinew("run", beam, "-q", "--set", "stepper=auto", "--set", "duration=0.1",
                           "--no-output")
        self.assertEqual(r.stdout, "")

    def test_a_budget_is_for_implicit_steps(self):
        r = self.run_sinew("run", SCENES / "beam.toml", "--set", "budget_ms=4", code=INPUT)
        self.assertIn("knows no budget_ms", r.stderr)


if __name__ == "__main__":
    unittest.main()
