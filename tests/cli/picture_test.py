"""tools/picture draws a run, or reports the fault."""

import importlib.util
import subprocess
import sys
import unittest

from cli_support import ROOT, SCENES, CliTest

NEEDED = ("numpy", "meshio", "matplotlib")
MISSING = [name for name in NEEDED if importlib.util.find_spec(name) is None]


@unittest.skipIf(MISSING, f"needs {', '.join(MISSING)}")
class PictureTest(CliTest):
    def picture(self, *args):
        command = [sys.executable, ROOT / "tools" / "picture", "out", "-o", "a.png", *args]
        return subprocess.run(command, cwd=self.dir, text=True, capture_output=True)

    def setUp(self):
        super().setUp()
        self.run_sinew("run", SCENES / "beam.toml", "--out", "out", "--quiet", "--set",
                       "duration=0.05", "--set", "beam.cells=[1,1,4]")

    def test_frames_beside_one_another(self):
        run = self.picture("--frame", "0,last", "--size", "200x120", "--ghost", "--color", "stretch")
        self.assertEqual(run.returncode, 0, run.stderr)
        data = (self.dir / "a.png").read_bytes()
        self.assertEqual(data[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual((int.from_bytes(data[16:20], "big"), int.from_bytes(data[20:24], "big")),
                         (200, 120))

    def test_quantities_of_tets_can_be_drawn(self):
        run = self.picture("--size", "200x120", "--color", "volume_ratio")
        self.assertEqual(run.returncode, 0, run.stderr)

    def test_mistakes_are_named(self):
        for args, words in ((("--frame", "99"), "no frame 99"),
                            (("--color", "warmth"), "no array 'warmth'; there are: ")):
            run = self.picture(*args)
            self.assertNotEqual(run.returncode, 0)
            self.assertIn(words, run.stderr)
            self.assertNotIn("Traceback", run.stderr)


if __name__ == "__main__":
    unittest.main()
