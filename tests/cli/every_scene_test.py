"""Every scene that comes with Sinew: info, the first frames, resume, the live view.

Short; the sanitizer builds run the whole program by it.
"""

import json
import unittest

from cli_support import ROOT, SCENES, CliTest

FRAMES = 2


class EverySceneTest(CliTest):
    def scenes(self):
        found = sorted(SCENES.glob("*.toml"))
        self.assertGreater(len(found), 10)
        return found

    # Frames are short, so that a sanitizer is done in minutes.
    settings = ("--set", "output.fps=240", "--set", f"duration={FRAMES / 240}")

    def test_run_and_resume(self):
        for scene in self.scenes():
            with self.subTest(scene.stem):
                self.run_sinew("run", scene, "--out", scene.stem, "--quiet", *self.settings,
                               timeout=600)
                copy = self.dir / scene.stem / "scene.toml"
                text = copy.read_text()
                self.assertIn(f"duration = {FRAMES / 240}", text)
                copy.write_text(text.replace(f"duration = {FRAMES / 240}",
                                             f"duration = {(FRAMES + 1) / 240}"))
                summary = json.loads(self.run_sinew("resume", scene.stem, "--json", "--quiet",
                                                    timeout=600).stdout)
                self.assertGreater(summary["frames"], FRAMES)

    def test_implicit_steps(self):
        for name in ("beam", "press", "drop"):
            with self.subTest(name):
                self.run_sinew("run", SCENES / f"{name}.toml", "--no-output", "--quiet",
                               "--set", "stepper=implicit", *self.settings, timeout=600)

    def test_course_scenes(self):
        folder = SCENES / "framework"
        self.run_sinew("run", folder / "chain-scene.txt", "--constraints",
                       folder / "chain-constraints.txt", "--no-output", "--quiet", "--young", "1e5",
                       *self.settings, timeout=600)

    def test_meshes(self):
        mesh = SCENES / "meshes" / "liver-10mm.mesh"
        self.run_sinew("info", mesh)
        for name in ("a.vtu", "b.vtk", "c.msh", "d.mesh"):
            self.run_sinew("convert", mesh, name)
            self.run_sinew("info", name)
        self.run_sinew("validate", "uniaxial", "--quick", "--dir", ROOT / "validation", timeout=600)

    def test_view(self):
        for scene in self.scenes():
            with self.subTest(scene.stem):
                with self.view(scene, "--quiet") as url:
                    for path in ("", "scene.toml", "state.vtu", "gallery.json"):
                        self.assertGreater(len(self.get(url, path)), 100, path)


if __name__ == "__main__":
    unittest.main()
