"""sinew bench: the table, its JSON, its options, Ctrl-C. No time is asserted."""

import json
import signal
import subprocess
import unittest

from cli_support import BIN, INPUT, IO, SCENES, USAGE, CliTest

ONE = ["--meshes", "2", "--threads", "1", "--seconds", "0"]
INTERRUPTED = 130


class BenchTest(CliTest):
    def test_quick_table(self):
        run = self.run_sinew("bench", "--quick", "--meshes", "4", "--threads", "1")
        for word in ("copy [GB/s]", "memory", "FMA", "network step", "implicit frame", "rest state",
                     "tangent product", "spring step", "single", "double", "share"):
            self.assertIn(word, run.stdout)
        self.assertIn("network step W(4) single, 1 thread", run.stderr)

    def test_json(self):
        out = self.dir / "bench.json"
        self.run_sinew("bench", *ONE, "-q", "--filter", "network step", "--json", out)
        result = json.loads(out.read_text())
        self.assertEqual(result["schema"], 1)
        self.assertEqual([r["precision"] for r in result["rows"]], ["single", "double"])
        row = result["rows"][0]
        self.assertEqual((row["mesh"], row["tets"], row["unit"]), ("W(2)", 160, "tet"))
        self.assertGreaterEqual(row["time"]["repetitions"], 5)
        self.assertRegex(row["hash"], "^[0-9a-f]{16}$")
        # Another run, on two threads, ends with the same bits.
        again = self.run_sinew("bench", "--meshes", "2", "--threads", "2", "--seconds", "0", "-q",
                               "--filter", "network step", "--json", "-")
        self.assertEqual([r["hash"] for r in json.loads(again.stdout)["rows"]],
                         [r["hash"] for r in result["rows"]])

    def test_scene(self):
        run = self.run_sinew("bench", SCENES / "liver.toml", *ONE, "--filter", "step liver single",
                             "-q", "--json", "-")
        rows = json.loads(run.stdout)["rows"]
        self.assertEqual([(r["kernel"], r["mesh"]) for r in rows],
                         [("network step", "liver"), ("spring step", "liver")])

    def test_peer(self):
        peer = self.write("peer", "#!/bin/sh\necho '{\"rows\": [{\"kernel\": \"theirs\", \"mesh\": "
                          "\"W(2)\", \"precision\": \"single\", \"threads\": 1, \"nodes\": 1, "
                          "\"tets\": 2, \"springs\": 3, \"unit\": \"link\", \"items\": 4, "
                          "\"time\": {\"median_s\": 1, \"min_s\": 1, \"spread\": 0, "
                          "\"repetitions\": 5, \"batch\": 1}}]}'\n")
        peer.chmod(0o755)
        run = self.run_sinew("bench", *ONE, "--filter", "spring step", "--peer", peer)
        self.assertIn("theirs", run.stdout)
        peer.write_text("#!/bin/sh\necho '{}'\n")
        wrong = self.run_sinew("bench", *ONE, "--filter", "spring step", "--peer", peer, code=INPUT)
        self.assertIn("not what sinew bench writes", wrong.stderr)
        wrong = self.run_sinew("bench", *ONE, "--filter", "spring step", "--peer", "no-such-program",
                               code=INPUT)
        self.assertIn("did not run to its end", wrong.stderr)

    def test_mistakes(self):
        wrong = self.run_sinew("bench", *ONE, "--filter", "steep", code=USAGE)
        self.assertIn("names are like 'network step W(2) single, 1 thread'", wrong.stderr)
        self.run_sinew("bench", "--meshes", "0", code=USAGE)
        self.run_sinew("bench", "none.toml", *ONE, code=IO)
        self.run_sinew("bench", *ONE, "-q", "--filter", "spring step", "--json",
                       self.dir / "no" / "folder.json", code=IO)

    def test_interrupted(self):
        process = subprocess.Popen([BIN, "bench", "--meshes", "4", "--threads", "1", "--seconds",
                                    "0.5"], cwd=self.dir, text=True, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE)
        for line in process.stderr:  # the machine's limits, then two rows
            if line.startswith("4/"):
                break
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, INTERRUPTED)
        self.assertIn("network forces", out)
        self.assertIn("Interrupted.", out)


if __name__ == "__main__":
    unittest.main()
