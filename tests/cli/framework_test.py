"""Scenes of the course framework: run, checked, resumed, refused with file and line."""

import json
import os
import unittest

from cli_support import INPUT, SCENES, USAGE, CliTest

SCENE = SCENES / "framework/chain-scene.txt"
CONSTRAINTS = SCENES / "framework/chain-constraints.txt"

MESH = """MeshVersionFormatted 1
Dimension 3
Vertices
4
0 0 0 0
1 0 0 0
0 1 0 0
0 0 1 0
Tetrahedra
1
1 2 3 4 0
End
"""
# A tetrahedron as a closed surface.
SURFACE = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n"


class FrameworkTest(CliTest):
    def summary(self, *args):
        return json.loads(self.run_sinew("run", *args, "--json").stdout)

    def test_the_shipped_chain_hangs_on_its_distances(self):
        s = self.summary(SCENE, "--constraints", CONSTRAINTS, "--no-output",
                         "--set", "duration=4")
        self.assertEqual(s["status"], "finished")
        self.assertEqual(s["limits"]["unmet_steps"], 0)
        self.assertLess(s["limits"]["violation"], 1e-3)
        self.assertEqual(s["warnings"], [])
        free = self.summary(SCENE, "--no-output", "--set", "duration=4")
        self.assertNotEqual(free["state_hash"], s["state_hash"])
        # The block strikes the platform.
        plastic = self.summary(SCENE, "--constraints", CONSTRAINTS, "--no-output",
                               "--restitution", "0", "--set", "duration=4")
        self.assertNotEqual(plastic["state_hash"], s["state_hash"])

    def test_a_run_is_resumed_from_its_own_words(self):
        options = (SCENE, "--constraints", CONSTRAINTS, "--set", "duration=0.5")
        whole = self.summary(*options, "-o", "whole")
        self.assertEqual(whole["scene"], "chain")
        self.assertTrue((self.dir / "whole/scene.toml").exists())
        again = self.summary(self.dir / "whole/scene.toml", "--no-output")
        self.assertEqual(again["state_hash"], whole["state_hash"])

    def test_a_material_of_nothing_needs_a_flag(self):
        self.write("tet.mesh", MESH)
        scene = self.write("tet-scene.txt", "1\ntet.mesh 100 0 0 0 0 5 0 1 0 0 0\n")
        r = self.run_sinew("run", scene, code=INPUT)
        self.assertIn("tet-scene.txt:2:14: object 1, tet.mesh, has a Young's modulus of 0", r.stderr)
        self.assertIn("--young", r.stderr)
        s = self.summary(scene, "--young", "1e4", "--poisson", "0.3", "--no-output",
                         "--set", "duration=0.1")
        self.assertEqual(s["status"], "finished")

    def test_options_go_with_such_a_scene_only(self):
        r = self.run_sinew("run", SCENES / "beam.toml", "--young", "1e4", code=USAGE)
        self.assertIn("go with a scene of the course framework", r.stderr)

    def test_a_surface_needs_the_mesher(self):
        self.write("tet.off", SURFACE)
        scene = self.write("tet-scene.txt", "1\ntet.off 100 1e5 0.3 0 0 50 0 1 0 0 0\n")
        environment = {**os.environ, "SINEW_MESH": str(self.dir / "none"),
                       "XDG_CACHE_HOME": str(self.dir / "cache")}
        r = self.run_sinew("run", scene, code=INPUT, env=environment)
        self.assertIn("tet-scene.txt:2:1:", r.stderr)
        self.assertIn("cannot be started", r.stderr)
        self.assertIn("./dev mesh", r.stderr)
        self.assertEqual(list((self.dir / "cache/sinew/meshes").iterdir()), [])


if __name__ == "__main__":
    unittest.main()
