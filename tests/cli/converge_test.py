"""sinew converge: three meshes, the order, the extrapolated value."""

import json
import unittest

from cli_support import INPUT, SCENES, USAGE, CliTest

STATIC = ["--set", "stepper=static", "--set", "beam.law=neo-hookean", "--set", "beam.beta=1",
          "--set", "beam.volume=tet", "--set", "beam.young=1.5e6", "--set", "beam.cells=[2,2,8]"]


class ConvergeTest(CliTest):
    def test_beam(self):
        run = self.run_sinew("converge", SCENES / "beam.toml", *STATIC, "--json")
        result = json.loads(run.stdout)
        self.assertEqual([level["tets"] for level in result["levels"]], [160, 1280, 10240])
        tip = result["probes"]["tip"]
        moves = [-u[1] for u in tip["displacement"]]
        self.assertEqual(moves, sorted(moves))  # linear tets are too stiff, the finer the less so
        # The converged tip of quadratic elements
        self.assertAlmostEqual(tip["extrapolated"][1], -0.0270, delta=tip["error"])
        self.assertLess(abs(tip["extrapolated"][1] + 0.0270), 0.001)
        # The coarsest mesh is no mesh to extrapolate from, and that is said.
        self.assertFalse(tip["converges"])
        self.assertIn("probe tip: the changes do not shrink", result["warnings"][0])

    def test_tables(self):
        run = self.run_sinew("converge", SCENES / "beam.toml", *STATIC, "--levels", "2")
        self.assertIn("extrapolated [mm]", run.stdout)
        self.assertIn("level 1 of 1", run.stderr)

    def test_mistakes(self):
        self.write("s.toml", '[body.b]\nshape = "box"\ncells = [1, 1, 1]\n')
        wrong = self.run_sinew("converge", "s.toml", code=INPUT)
        self.assertIn("the scene has no probe", wrong.stderr)
        self.run_sinew("converge", "s.toml", "--levels", "9", code=USAGE)
        wrong = self.run_sinew("converge", SCENES / "beam.toml", "--set", "beam.refine=4",
                               code=INPUT)
        self.assertIn("3 levels would need 6", wrong.stderr)


if __name__ == "__main__":
    unittest.main()
