"""sinew view: its output, the files it opens, its end. The page has separate tests."""

import json
import re
import unittest

from cli_support import INPUT, IO, SCENES, USAGE, CliTest


class ViewTest(CliTest):
    def test_a_scene(self):
        with self.view(SCENES / "beam.toml", "--set", "beam.young=33e3", "--quiet") as url:
            self.assertRegex(url, r"^http://127\.0\.0\.1:\d+/$")
            self.assertIn("<!doctype html>", self.get(url))
            self.assertIn("young = 33000", self.get(url, "scene.toml"))
            self.assertIn("<VTKFile", self.get(url, "state.vtu"))

    def test_without_a_scene_the_gallery(self):
        with self.view() as url:
            names = [scene["name"] for scene in json.loads(self.get(url, "gallery.json"))]
            self.assertIn("beam", names)
            self.assertIn("liver", names)

    def test_a_mesh_by_its_bare_name(self):
        self.run_sinew("convert", SCENES / "meshes" / "liver-10mm.mesh", "liver.msh")
        with self.view("liver.msh", "--quiet") as url:
            self.assertIn('mesh = "liver.msh"', self.get(url, "scene.toml"))

    def test_another_gallery(self):
        scene = self.write("own/mine.toml", '[body.a]\nshape = "box"\n[pin.p]\nselect = {side="+y"}\n')
        self.write("own/broken.toml", "[")
        with self.view(scene, "--scenes", "own") as url:
            names = [scene["name"] for scene in json.loads(self.get(url, "gallery.json"))]
            self.assertEqual(names, ["mine"])
        error = self.run_sinew("view", "--scenes", "own", "--port", 0, code=USAGE).stderr
        self.assertIn("name a scene", error)

    def test_a_mesh_alone(self):
        with self.view(SCENES / "meshes/liver-10mm.mesh", "--set", "liver-10mm.young=7e3") as url:
            scene = self.get(url, "scene.toml")
            self.assertTrue(re.search(r"young = 7000", scene), scene)
            self.assertIn("0.001", scene)

    def test_other_machines_need_the_token(self):
        with self.view(SCENES / "beam.toml", "--host", "0.0.0.0") as url:
            self.assertRegex(url, r"\?token=[0-9a-f]{32}$")
            self.assertIn("<!doctype html>", self.get(url))

    def test_what_cannot_be_shown(self):
        bad = self.write("bad.toml", "[body.a]\nshape = \"box\"\nyoung = -1\n")
        self.assertIn("bad.toml:3", self.run_sinew("view", bad, code=INPUT).stderr)
        self.assertIn("missing", self.run_sinew("view", "missing.vtu", code=None).stderr)
        self.run_sinew("view", SCENES / "beam.toml", "--port", "70000", code=USAGE)
        with self.view(SCENES / "beam.toml") as url:
            port = url.split(":")[2].strip("/")
            error = self.run_sinew("view", SCENES / "beam.toml", "--port", port, code=IO).stderr
            self.assertIn("--port 0", error)


if __name__ == "__main__":
    unittest.main()
