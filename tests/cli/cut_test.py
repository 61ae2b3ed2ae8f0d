"""Cuts of a scene from the command line: frames, summary, resume, mistakes."""

import json
import re
import unittest

from cli_support import INPUT, CliTest

SCENE = """duration = 0.3
[body.beam]
shape = "beam"
cells = [3, 3, 12]
young = 5e4
[pin.wall]
select = { side = "-z" }
[probe.tip]
select = { side = "+z" }
[cut.slit]
blade = [
  { time = 0.05, heel = [0.06, 0.06, 0.11], tip = [0.06, -0.06, 0.11] },
  { time = 0.2, heel = [0, 0.06, 0.11], tip = [0, -0.06, 0.11] },
]
at_rest = true
[cut.across]
time = 0.1
plane = { point = [0, 0, 0.31], normal = [0.1, 0, 1] }
at_rest = true
"""


class CutTest(CliTest):
    def cells(self, name, frame):
        text = (self.dir / name / "frames" / f"scene_{frame:04}.vtu").read_text(errors="replace")
        return int(re.search(r'NumberOfCells="(\d+)"', text).group(1))

    def test_frames_and_summary_follow_the_cuts(self):
        self.write("scene.toml", SCENE)
        text = self.run_sinew("run", "scene.toml", "--out", "out").stdout
        self.assertRegex(text, r"cut +across by 0\.1 s: \d+ faces")
        self.assertRegex(text, r"cut +slit by ")
        self.assertLess(self.cells("out", 0), self.cells("out", 9))
        summary = json.loads((self.dir / "out" / "summary.json").read_text())
        cuts = {cut["name"]: cut for cut in summary["cuts"]}
        self.assertEqual(cuts["across"]["pieces"], [1, 2])
        self.assertAlmostEqual(cuts["across"]["area"], 0.01, delta=0.002)
        self.assertLessEqual(cuts["across"]["elastic"][1], cuts["across"]["elastic"][0])
        self.assertEqual(summary["mesh"]["tets"], self.cells("out", 9))
        self.assertLess(summary["energy"]["peak_drift"], 0.01 * summary["energy"]["peak"])

    def test_a_run_that_was_cut_goes_on_with_the_same_bits(self):
        self.write("scene.toml", SCENE)
        whole = json.loads(self.run_sinew("run", "scene.toml", "--out", "whole", "--json").stdout)
        self.run_sinew("run", "scene.toml", "--out", "half", "--quiet", "--set", "duration=0.1")
        copy = self.dir / "half" / "scene.toml"
        copy.write_text(copy.read_text().replace("duration = 0.1", "duration = 0.3"))
        resumed = json.loads(self.run_sinew("resume", "half", "--json").stdout)
        self.assertEqual(resumed["state_hash"], whole["state_hash"])
        self.assertEqual(len(resumed["cuts"]), 2)
        self.assertEqual(self.cells("half", 9), self.cells("whole", 9))

    def test_rest_states_of_a_cut_body(self):
        self.write("scene.toml", SCENE.replace("duration = 0.3", 'duration = 0.3\nstepper = "static"')
                   .replace("[cut.across]", "[cut.shallow]").replace("plane = {", "disc = { radius = 0.02,")
                   .replace("point =", "center ="))
        summary = json.loads(self.run_sinew("run", "scene.toml", "--out", "out", "--json").stdout)
        self.assertEqual(summary["status"], "finished")
        self.assertGreater(len(summary["cuts"]), 0)

    def test_mistakes_are_named_before_the_run(self):
        for cut, expected in (
                ("", "has none of 'plane', 'disc', 'blade' and 'mesh'"),
                ('mesh = "nowhere.stl"', "is not there"),
                ("plane = { point = [0, 0, 0] }", "has no 'normal'"),
                ('body = "bean"\nplane = { point = [0, 0, 0], normal = [0, 0, 1] }', "bean")):
            with self.subTest(cut):
                self.write("scene.toml", f'[body.beam]\nshape = "beam"\n[cut.a]\n{cut}\n')
                result = self.run_sinew("run", "scene.toml", "--out", "out", code=INPUT)
                self.assertIn(expected, result.stderr)
                self.assertFalse((self.dir / "out").exists())


if __name__ == "__main__":
    unittest.main()
