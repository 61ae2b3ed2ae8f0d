"""sinew feel: its devices, output and mistakes. The loop itself has tests in tests/haptics."""

import json
import unittest

from cli_support import INPUT, SCENES, USAGE, CliTest

SCENE = SCENES / "palpate.toml"
PATH = SCENES / "paths/palpate.csv"


class FeelTest(CliTest):
    def test_a_hand(self):
        result = self.run_sinew("feel", SCENE, "--tool", "finger", "--hand", PATH, "--seconds", 1,
                                "--log", "felt.csv", "--metrics", "graded.json", "--force-limit", 0.1, "--json")
        graded = json.loads((self.dir / "graded.json").read_text())
        self.assertEqual([tool["name"] for tool in graded["tools"]], ["finger"])
        self.assertGreater(graded["tools"][0]["path"], 0)
        felt = json.loads(result.stdout)
        self.assertGreater(felt["ticks"], 100)
        self.assertGreater(felt["exchanges"], 10)
        rows = (self.dir / "felt.csv").read_text().splitlines()
        self.assertIn(len(rows), range(5, 53))
        self.assertAlmostEqual(float(rows[-1].split(",")[0]), 1, delta=0.2)
        self.assertTrue(rows[0].startswith("time [s],x [m]"))
        self.run_sinew("feel", SCENE, "--tool", "finger", "--hand", PATH, "--seconds", 1, "--log",
                       "felt.csv", code=USAGE)

    def test_a_path_without_resistance(self):
        out = self.run_sinew("feel", SCENE, "--tool", "finger", "--path", PATH, "--seconds", 0.2).stdout
        self.assertIn("ticks", out)
        self.assertIn("real time", out)

    def test_a_device_over_the_network(self):
        result = self.run_sinew("feel", SCENE, "--tool", "finger", "--listen", 0, "--seconds", 0.2)
        self.assertRegex(result.stderr, r"ws://127\.0\.0\.1:\d+")

    def test_mistakes(self):
        self.assertIn("0 devices", self.run_sinew("feel", SCENE, "--tool", "finger", code=USAGE).stderr)
        error = self.run_sinew("feel", SCENE, "--tool", "thumb", "--path", PATH, code=USAGE).stderr
        self.assertIn("finger", error)
        bad = self.write("bad.csv", "0, 0, 0, 0\n1, 0, x, 0\n")
        error = self.run_sinew("feel", SCENE, "--tool", "finger", "--path", bad, code=INPUT).stderr
        self.assertIn("bad.csv:2", error)


if __name__ == "__main__":
    unittest.main()
