"""Implicit steps come to rest at the rest states: at any stiffness, bone in fat, with slivers,
dropped inverted. tools/stiffness_table.py, short, and a cube on the ground."""

import json
import subprocess
import sys
import unittest

from cli_support import BIN, ROOT, CliTest

CUBE = """
stepper = "implicit"
duration = 3

[body.cube]
shape = "box"
size = [0.1, 0.1, 0.1]
cells = [4, 4, 4]
damping_ratio = 0
drag = 2
position = [0, 0.1, 0]

[ground]
friction = 0
"""
SIDES = ("-x", "+x", "-y", "+y", "-z", "+z")


class StiffnessTest(CliTest):
    def table(self, *args):
        """Runs the tool, which compares and ends with 1 where they differ; returns its output."""
        r = subprocess.run([sys.executable, ROOT / "tools/stiffness_table.py", "--sinew", BIN,
                            "--dt", "1/30", *args], text=True, capture_output=True, timeout=250)
        self.assertEqual(r.returncode, 0, r.stdout + r.stderr)
        self.assertNotIn("MISS", r.stdout)
        return r.stdout

    def test_six_decades(self):
        out = self.table("--k", "2", "--young", "1e3", "1e5", "1e7", "1e9",
                         "--poisson", "0.3", "0.499")
        self.assertEqual(out.count("beam k 2 E "), 8)

    def test_bone_in_fat(self):
        out = self.table("--body", "bone-core", "bone-layer", "--young", "1e9",
                         "--poisson", "0.45")
        self.assertIn("bone-layer k 4 E 1e+09", out)

    def test_bone_that_hangs_on_fat(self):
        self.table("--body", "bone-end", "--young", "1e9", "--poisson", "0.3")

    def test_slivers(self):
        out = self.table("--body", "slivers", "--young", "1e3", "1e6", "1e9", "--poisson", "0.45")
        self.assertIn("1536 tets, 64 of at most 0.001 of the mean volume; smallest 0.001,", out)

    def drop(self, *sets):
        """(height of the middle of each side of the cube [m], the summary)."""
        probes = [f'[probe.side{i}]\nselect = {{ side = "{s}" }}\n' for i, s in enumerate(SIDES)]
        scene = self.write("cube.toml", CUBE + "\n".join(probes))
        words = [word for s in sets for word in ("--set", s)]
        r = self.run_sinew("run", scene, *words, "--no-output", "--json")
        summary = json.loads(r.stdout)
        return [p["position"][1] for p in summary["probes"].values()], summary

    def test_a_cube_dropped_inside_out(self):
        # It comes to lie on whichever side: a mirrored cube is turned where that is least way.
        for young in ("1e4", "1e6", "1e9"):
            with self.subTest(young=young):
                sides, end = self.drop(f"cube.young={young}", "cube.start=inverted")
                rest_sides, rest = self.drop(f"cube.young={young}", "stepper=static")
                self.assertGreater(end["peak_inverted_tets"], 0)
                self.assertEqual(end["inverted_tets"], 0)
                self.assertLess(end["energy"]["kinetic"], 1e-6)
                self.assertAlmostEqual(min(sides), 0.0, delta=1e-5)
                self.assertAlmostEqual(max(sides), max(rest_sides), delta=1e-4)
                self.assertAlmostEqual(end["volume_ratio"] / rest["volume_ratio"], 1.0, delta=0.01)


if __name__ == "__main__":
    unittest.main()
