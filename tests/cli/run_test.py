"""sinew run and sinew resume: outputs, JSON, overrides, Ctrl-C, kill -9, threads, errors."""

import csv
import json
import random
import signal
import subprocess
import sys
import time
import unittest

from cli_support import BIN, DIVERGED, INPUT, SCENES, UNSTABLE, USAGE, CliTest

BEAM = SCENES / "beam.toml"
# About two seconds of work with a checkpoint at every frame: long enough to be killed anywhere.
LONG = ["--set", "beam.cells=[8,8,32]", "--set", "duration=0.4", "--set", "output.checkpoint=0",
        "--set", "output.fps=250", "--set", "output.encoding=base64"]


class RunTest(CliTest):
    def summary(self, *args, code=0):
        return json.loads(self.run_sinew("run", *args, "--json", code=code).stdout)

    def test_workload_8_by_overrides(self):
        s = self.summary(BEAM, "--no-output", "--set", "beam.cells=[8,8,32]",
                         "--set", "beam.young=1.5e6", "--set", "beam.poisson=0.45",
                         "--set", 'beam.law="lloyd"', "--set", "duration=0.02")
        self.assertEqual(s["mesh"]["tets"], 10240)
        self.assertEqual(s["mesh"]["nodes"], 9 * 9 * 33)
        self.assertEqual(s["laws"], {"beam": "lloyd"})
        self.assertEqual(s["stepper"], "verlet")
        self.assertIn("tip", s["probes"])

    def test_bare_words_and_law_by_override(self):
        for law in ("uniform", "lloyd", "vangelder"):
            s = self.summary(BEAM, "--no-output", "--set", f"beam.law={law}",
                             "--set", "duration=0.001")
            self.assertEqual(s["laws"]["beam"], law)

    def test_table_names_everything(self):
        text = self.run_sinew("run", BEAM, "--set", "duration=0.1").stdout
        for word in ("mesh", "law", "springs", "step", "wall time", "real time", "energy", "volume",
                     "stretch", "shortest", "probe", "state hash", "Wrote out/beam", "paraview"):
            self.assertIn(word, text)
        self.assertTrue((self.dir / "out/beam/beam.pvd").exists())
        self.run_sinew("run", BEAM, "--set", "duration=0.1")  # does not overwrite
        self.assertTrue((self.dir / "out/beam-2/beam.pvd").exists())

    def test_scenes_that_come_with_it_are_pointed_to(self):
        for command in ("run", "view"):
            result = self.run_sinew(command, "nowhere/liver.toml", code=6)
            self.assertIn("nowhere/liver.toml: there is no such scene file", result.stderr)
            self.assertRegex(result.stderr, f"sinew {command} .*scenes/liver.toml")
        self.assertIn("check the path", self.run_sinew("run", "no.toml", code=6).stderr)

    def test_quiet_prints_nothing(self):
        r = self.run_sinew("run", BEAM, "-q", "--no-output", "--set", "duration=0.1")
        self.assertEqual((r.stdout, r.stderr), ("", ""))

    def test_same_bits_for_one_and_two_threads(self):
        args = (BEAM, "--no-output", "--set", "duration=0.1", "--set", "beam.cells=[8,8,32]")
        one = self.summary(*args, "--threads", "1")
        two = self.summary(*args, "--threads", "2")
        self.assertEqual(one["state_hash"], two["state_hash"])

    def test_probes_csv_ends_where_the_summary_does(self):
        s = self.summary(BEAM, "-o", "o", "--set", "duration=0.2")
        with open(self.dir / "o/probes.csv", encoding="utf-8") as f:
            rows = list(csv.DictReader(f))
        self.assertEqual(len(rows), 7)
        self.assertEqual(float(rows[-1]["tip.uy [m]"]), s["probes"]["tip"]["displacement"][1])
        self.assertEqual(float(rows[-1]["time [s]"]), s["sim_seconds"])

    def test_frames_are_read_by_meshio(self):
        try:
            import meshio
        except ImportError:
            self.skipTest("meshio is not installed")
        for encoding in ("zlib", "base64", "ascii"):
            self.run_sinew("run", BEAM, "-o", encoding, "--set", "duration=0.1",
                           "--set", f"output.encoding={encoding}")
            mesh = meshio.read(self.dir / encoding / "frames/beam_0003.vtu")
            self.assertEqual(mesh.points.shape, (425, 3))
            self.assertEqual(mesh.cells_dict["tetra"].shape, (1280, 4))
            self.assertEqual(mesh.point_data["displacement"].shape, (425, 3))
            self.assertEqual(mesh.point_data["pinned"].sum(), 25)
            self.assertLess(mesh.point_data["displacement"][:, 1].min(), -1e-4)

    def test_an_existing_run_is_not_overwritten(self):
        self.run_sinew("run", BEAM, "-o", "o", "--set", "duration=0.01")
        r = self.run_sinew("run", BEAM, "-o", "o", "--set", "duration=0.01", code=USAGE)
        self.assertIn("the folder already holds a run", r.stderr)
        self.run_sinew("run", BEAM, "-o", "o", "--set", "duration=0.01", "--force")

    def test_too_large_a_step_is_refused(self):
        r = self.run_sinew("run", BEAM, "-o", "o", "--set", "dt=0.1", code=UNSTABLE)
        self.assertIn("largest stable one", r.stderr)
        self.assertIn("substeps = ", r.stderr)

    def test_a_run_that_diverges_says_where_and_keeps_its_files(self):
        r = self.run_sinew("run", BEAM, "-o", "o", "--set", "dt=0.01", "--set",
                           "allow_unstable=true", code=DIVERGED)
        self.assertIn("body beam, node ", r.stderr)
        self.assertEqual(json.loads((self.dir / "o/summary.json").read_text())["status"],
                         "diverged")

    def test_unknown_keys_name_the_nearest(self):
        r = self.run_sinew("run", BEAM, "--set", "beam.yuong=1", code=INPUT)
        self.assertIn("'young'", r.stderr)

    def test_resume_of_nothing(self):
        r = self.run_sinew("resume", "nowhere", code=INPUT)
        self.assertIn("nothing to resume", r.stderr)

    def start(self, *args):
        return subprocess.Popen([BIN, "run", str(BEAM), *LONG, *args, "-q"], cwd=self.dir,
                                stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)

    def test_ctrl_c_saves_and_says_how_to_go_on(self):
        whole = self.summary(BEAM, *LONG, "--no-output")
        run = subprocess.Popen([BIN, "run", str(BEAM), *LONG, "-o", "o"], cwd=self.dir,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        while not (self.dir / "o/frames/beam_0003.vtu").exists():
            time.sleep(0.01)
        run.send_signal(signal.SIGINT)
        out, _ = run.communicate(timeout=60)
        self.assertEqual(run.returncode, 130)
        self.assertIn("sinew resume o", out)
        rest = json.loads(self.run_sinew("resume", "o", "--json").stdout)
        self.assertEqual(rest["state_hash"], whole["state_hash"])
        self.assertEqual(rest["status"], "finished")

    def test_killed_at_ten_random_moments(self):
        whole = self.summary(BEAM, *LONG, "-o", "whole")
        probes = (self.dir / "whole/probes.csv").read_bytes()
        seed = random.SystemRandom().randrange(10**6)
        print("seed", seed, file=sys.stderr)
        moments = random.Random(seed)
        killed = 0
        for i in range(10):
            folder = f"killed-{i}"
            run = self.start("-o", folder)
            # After one of the hundred frames, somewhere on the way to the next; or early, before
            # there is anything to go on with.
            frame = self.dir / folder / f"frames/beam_{moments.randrange(0, 80):04}.vtu"
            while i > 0 and not frame.exists() and run.poll() is None:
                time.sleep(0.002)
            time.sleep(moments.uniform(0.0, 0.02))
            killed += run.poll() is None
            run.kill()
            run.communicate()
            if (self.dir / folder / "checkpoint.bin").exists():
                rest = json.loads(self.run_sinew("resume", folder, "--json").stdout)
            else:  # killed before the first checkpoint: there is nothing to go on with
                self.run_sinew("resume", folder, code=INPUT)
                rest = self.summary(BEAM, *LONG, "-o", folder, "--force")
            self.assertEqual(rest["state_hash"], whole["state_hash"])
            self.assertEqual((self.dir / folder / "probes.csv").read_bytes(), probes)
            self.assertEqual(list((self.dir / folder).rglob("*.tmp")), [])
        self.assertGreaterEqual(killed, 5)

    def test_killed_twice(self):
        whole = self.summary(BEAM, *LONG, "--no-output")
        run = self.start("-o", "o")
        while not (self.dir / "o/frames/beam_0005.vtu").exists():
            time.sleep(0.005)
        run.kill()
        run.communicate()
        run = subprocess.Popen([BIN, "resume", "o", "-q"], cwd=self.dir)
        while not (self.dir / "o/frames/beam_0030.vtu").exists():
            time.sleep(0.005)
        run.kill()
        run.wait()
        rest = json.loads(self.run_sinew("resume", "o", "--json", "--threads", "1").stdout)
        self.assertEqual(rest["state_hash"], whole["state_hash"])


class HelpTest(CliTest):
    def test_version(self):
        self.assertRegex(self.run_sinew("--version").stdout, r"^sinew \d+\.\d+\.\d+\n$")

    def test_every_help_has_examples(self):
        for command in ([], ["run"], ["resume"], ["info"], ["convert"], ["completion"]):
            self.assertIn("xample", self.run_sinew(*command, "--help").stdout)

    def test_wrong_usage(self):
        for args in ([], ["runn"], ["run"], ["run", BEAM, "--sett"],
                     ["run", BEAM, "--threads", "-1"]):
            self.run_sinew(*args, code=USAGE)


if __name__ == "__main__":
    unittest.main()
