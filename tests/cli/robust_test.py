"""What a user cannot lose and cannot misread: files, locks, exit codes, warnings before the run."""

import fcntl
import json
import os
import pathlib
import shutil
import signal
import subprocess
import time
import unittest

from cli_support import BIN, DIVERGED, INPUT, IO, ROOT, SCENES, USAGE, CliTest

CASES = ROOT / "tests" / "data" / "robust"
BEAM = SCENES / "beam.toml"
SHORT = ["--set", "duration=0.1"]


class RunFolderTest(CliTest):
    def files(self):
        return {str(p.relative_to(self.dir)): p.read_bytes()
                for p in self.dir.rglob("*") if p.is_file()}

    def edit(self, before, after):
        scene = self.dir / "o/scene.toml"
        text = scene.read_text(encoding="utf-8")
        self.assertIn(before, text)
        scene.write_text(text.replace(before, after), encoding="utf-8")


class FolderTest(RunFolderTest):
    def test_the_scene_itself_is_never_replaced(self):
        shutil.copy(CASES / "overwrites_own_scene.toml", self.dir / "scene.toml")
        before = self.files()
        r = self.run_sinew("run", "scene.toml", "--out", ".", *SHORT, code=USAGE)
        self.assertIn("files that Sinew did not write: scene.toml", r.stderr)
        self.assertEqual(self.files(), before)
        r = self.run_sinew("run", "scene.toml", "--out", ".", "--force", *SHORT, code=USAGE)
        self.assertIn("scene.toml: Sinew did not write this file", r.stderr)
        self.assertEqual({k: v for k, v in self.files().items() if k != "run.lock"}, before)

    def test_force_leaves_what_sinew_did_not_write(self):
        self.run_sinew("run", BEAM, "-o", "o", *SHORT)
        mine = {"o/notes.txt": "mine", "o/frames/mine.vtu": "mine", "o/my-force.svg": "mine",
                "o/frames/beam_00.vtu": "mine"}
        for name, text in mine.items():
            self.write(name, text)
        self.run_sinew("run", BEAM, "-o", "o", "--force", "--set", "duration=0.05")
        for name, text in mine.items():
            self.assertEqual((self.dir / name).read_text(encoding="utf-8"), text)
        self.assertFalse((self.dir / "o/frames/beam_0003.vtu").exists())

    def test_a_foreign_file_in_the_way_is_kept(self):
        self.write("o/probes.csv", "mine")
        self.run_sinew("run", BEAM, "-o", "o", *SHORT, code=USAGE)
        r = self.run_sinew("run", BEAM, "-o", "o", "--force", *SHORT, code=USAGE)
        self.assertIn("probes.csv: Sinew did not write this file", r.stderr)
        self.assertEqual((self.dir / "o/probes.csv").read_text(encoding="utf-8"), "mine")

    def test_an_edited_scene_is_not_replaced(self):
        self.run_sinew("run", BEAM, "-o", "o", *SHORT)
        scene = self.dir / "o/scene.toml"
        scene.write_text(scene.read_text(encoding="utf-8") + "# mine\n", encoding="utf-8")
        r = self.run_sinew("run", BEAM, "-o", "o", "--force", *SHORT, code=USAGE)
        self.assertIn("edited after Sinew wrote it", r.stderr)
        self.assertIn("# mine", scene.read_text(encoding="utf-8"))

    def test_an_input_in_the_folder_is_not_removed(self):
        self.run_sinew("run", BEAM, "-o", "o", *SHORT)
        r = self.run_sinew("run", "o/scene.toml", "-o", "o", "--force", code=USAGE)
        self.assertIn("the run reads this file", r.stderr)

    def test_a_locked_folder_names_the_process(self):
        self.run_sinew("run", BEAM, "-o", "o", *SHORT)
        before = self.files()
        with open(self.dir / "o/run.lock", "rb") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            for args in (["resume", "o"], ["run", BEAM, "-o", "o", "--force"]):
                r = self.run_sinew(*args, code=USAGE)
                self.assertRegex(r.stderr, r"another run is writing here \(process \d+\)")
        self.assertEqual(self.files(), before)
        self.run_sinew("resume", "o", "-q")

    def test_a_killed_run_leaves_no_lock(self):
        run = subprocess.Popen([BIN, "run", BEAM, "-o", "o", "-q", "--set", "duration=100",
                                "--set", "output.checkpoint=0"], cwd=self.dir)
        while not (self.dir / "o/checkpoint.bin").exists():
            time.sleep(0.01)
        r = self.run_sinew("resume", "o", code=USAGE)
        self.assertIn(f"(process {run.pid})", r.stderr)
        run.kill()
        run.wait()
        with open(self.dir / "o/run.lock", "rb") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)


class ResumeTest(RunFolderTest):
    def test_edits_that_change_the_run_are_refused_by_name(self):
        self.run_sinew("run", BEAM, "-o", "o", *SHORT, "--set", "beam.poisson=0.3")
        before = self.files()
        self.edit("poisson = 0.3", "poisson = 0.4")
        scene = self.dir / "o/scene.toml"
        scene.write_text('stepper = "implicit"\ntolerance = 1e-4\n'
                         + scene.read_text(encoding="utf-8"), encoding="utf-8")
        r = self.run_sinew("resume", "o", code=INPUT)
        for text in ("body.beam.poisson was 0.3, is now 0.4", "stepper was not given, is now "
                     '"implicit"', "tolerance was not given, is now 0.0001"):
            self.assertIn(text, r.stderr)
        after = self.files()
        del before["o/scene.toml"], before["o/run.lock"], after["o/scene.toml"], after["o/run.lock"]
        self.assertEqual(after, before)

    def test_a_longer_duration_has_the_bits_of_the_longer_run(self):
        self.run_sinew("run", BEAM, "-o", "o", *SHORT)
        self.edit("duration = 0.1", "duration = 0.2")
        rest = json.loads(self.run_sinew("resume", "o", "--json").stdout)
        whole = json.loads(self.run_sinew("run", BEAM, "--no-output", "--json", "--set",
                                          "duration=0.2").stdout)
        self.assertEqual(rest["state_hash"], whole["state_hash"])
        self.edit("duration = 0.2", "duration = 0.1")
        r = self.run_sinew("resume", "o", code=INPUT)
        self.assertIn("has reached 0.2 s already", r.stderr)

    def test_other_frames_keep_time_monotone(self):
        for fps, name in (("60", "o"), ("7", "o")):
            shutil.rmtree(self.dir / name, ignore_errors=True)
            self.run_sinew("run", BEAM, "-o", name, *SHORT, "--set", "output.fps=30")
            self.edit("duration = 0.1", "duration = 0.2")
            self.edit("fps = 30", f"fps = {fps}")
            rest = json.loads(self.run_sinew("resume", name, "--json").stdout)
            rows = (self.dir / name / "probes.csv").read_text(encoding="utf-8").splitlines()[1:]
            times = [float(row.split(",")[0]) for row in rows]
            self.assertEqual(times, sorted(set(times)))
            self.assertAlmostEqual(times[-1], 0.2)
            self.assertEqual(rest["frames"], len(rows) - 1)
            self.assertLess(rest["energy"]["kinetic"], 10.0)


class OutputTest(CliTest):
    def test_lost_output_is_exit_6(self):
        mesh = SCENES / "meshes" / "liver-10mm.mesh"
        for args in (["run", BEAM, "--no-output", "--json", *SHORT],
                     ["run", BEAM, "--no-output", *SHORT], ["info", mesh], ["info", mesh, "--json"],
                     ["materials"], ["materials", "--json"], ["completion", "bash"], ["--help"],
                     ["--version"], ["convert", mesh, "a.vtu"]):
            with self.subTest(args=args), open("/dev/full", "w", encoding="utf-8") as full:
                r = subprocess.run([BIN, *map(str, args)], cwd=self.dir, stdout=full,
                                   stderr=subprocess.PIPE, text=True, check=False)
                self.assertEqual(r.returncode, IO, r.stderr)
                self.assertIn("standard output cannot be written", r.stderr)

    def test_paths_that_the_system_refuses(self):
        r = self.run_sinew("run", BEAM, *SHORT, "--out", "x" * 300, code=IO)
        self.assertIn("File name too long", r.stderr)
        os.symlink("loop", self.dir / "loop")
        r = self.run_sinew("run", BEAM, *SHORT, "--out", "loop/o", code=IO)
        self.assertIn("symbolic links", r.stderr)
        for command in ("resume", "run", "info"):
            r = self.run_sinew(command, "x" * 300, code=IO)
            self.assertIn("File name too long", r.stderr)

    def test_a_mesh_name_is_never_an_option(self):
        mesher = self.write("mesher", '#!/bin/sh\necho "$1" > "$HERE/told"\nexit 1\n')
        mesher.chmod(0o755)
        self.write("-o.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
        scene = self.write("s.toml", '[body.b]\nmesh = "-o.off"\n')
        env = {**os.environ, "SINEW_MESH": str(mesher), "HERE": str(self.dir),
               "XDG_CACHE_HOME": str(self.dir / "cache")}
        self.run_sinew("run", scene, "--no-output", code=INPUT, env=env)
        self.assertTrue(pathlib.Path((self.dir / "told").read_text().strip()).is_absolute())


class CasesTest(CliTest):
    def warnings(self, case, *args):
        r = self.run_sinew("run", CASES / f"{case}.toml", "--no-output", "--json", *args)
        told = json.loads(r.stdout)["warnings"]
        for text in told:
            if " starts " in text or "jumps" in text or "cannot hold" in text:
                self.assertIn("warning: " + text, r.stderr)
        return json.loads(r.stdout), "\n".join(told)

    def test_steps_out_of_range_are_refused(self):
        for case, text in (("segv_implicit_dt1e300", "expected in (0, 1000000]"),
                           ("dt1e-21", "would take 2e+20 steps"),
                           ("safety1e-10", "expected from 0.001 to 1"),
                           ("nan_state_rc0", "1e+22; expected from -1000000000")):
            with self.subTest(case=case):
                r = self.run_sinew("run", CASES / f"{case}.toml", "--no-output", code=INPUT)
                self.assertIn(text, r.stderr)
        r = self.run_sinew("run", CASES / "dt1e-21.toml", "--no-output", "--set", "dt=0.5",
                           code=INPUT)
        self.assertIn("longer than the whole run", r.stderr)

    def test_a_run_of_years_is_announced(self):
        run = subprocess.Popen([BIN, "run", CASES / "dt1e-21.toml", "--no-output", "--set",
                                "dt=1e-12"], cwd=self.dir, stderr=subprocess.PIPE, text=True,
                               stdout=subprocess.DEVNULL)
        line = run.stderr.readline()
        while "would take at least" not in line:
            self.assertTrue(line)
            line = run.stderr.readline()
        run.send_signal(signal.SIGINT)
        run.communicate(timeout=10)
        self.assertEqual(run.returncode, 130)
        self.assertIn("2e+11 steps of 1e-12 s", line)

    def test_a_state_that_is_not_finite_diverges(self):
        text = (CASES / "nan_state_rc0.toml").read_text(encoding="utf-8")
        scene = self.write("s.toml", text.replace("1e22, 1e160", "1e9, 1e9"))
        r = self.run_sinew("run", scene, "--no-output", "--json", code=None)
        self.assertIn(r.returncode, (0, DIVERGED))
        energy = json.loads(r.stdout)["energy"]
        self.assertNotIn(None, energy.values())

    def test_distance_that_cannot_hold(self):
        summary, told = self.warnings("distance_cannot_hold")
        self.assertIn("distance d cannot hold: both of its ends are pinned, 1.6", told)
        self.assertGreater(summary["limits"]["violation"], 10)

    def test_starts_that_jump(self):
        for case, text in (("starts_inside_obstacle", "body b starts inside obstacle o: 64 of its"),
                           ("ground_10m_above", "body b starts below the ground: 64 of its 64"),
                           ("same_place_contact", "bodies b and c overlap at the start"),
                           ("pin_jump", "pin a jumps at 0 s: it moves 1 m in 1e-09 s")):
            with self.subTest(case=case):
                r = self.run_sinew("run", CASES / f"{case}.toml", "--no-output", code=None)
                self.assertIn(text, r.stderr)

    def test_quiet_warnings_are_in_the_summary(self):
        r = self.run_sinew("run", CASES / "starts_inside_obstacle.toml", "-o", "o", "-q", code=None)
        self.assertEqual((r.stdout, r.stderr), ("", ""))
        summary = json.loads((self.dir / "o/summary.json").read_text(encoding="utf-8"))
        self.assertIn("starts inside obstacle o", summary["warnings"][0])

    def test_delivered_scenes_start_without_a_warning(self):
        for scene in sorted(SCENES.glob("*.toml")):
            with self.subTest(scene=scene.name):
                r = self.run_sinew("run", scene, "--no-output", "-q", "--json", "--set",
                                   "duration=0.05", code=None)
                for text in json.loads(r.stdout)["warnings"]:
                    for fault in (" starts ", "jumps", "cannot hold", "would take at least"):
                        self.assertNotIn(fault, text)


class InterruptTest(CliTest):
    def interrupted(self, args, after):
        run = subprocess.Popen([BIN, *map(str, args)], cwd=self.dir, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True)
        time.sleep(after)
        self.assertIsNone(run.poll(), "too short to be interrupted")
        start = time.monotonic()
        run.send_signal(signal.SIGINT)
        run.communicate(timeout=60)
        self.assertEqual(run.returncode, 130)
        return time.monotonic() - start

    def test_building_and_solving_end_at_once(self):
        big = ["--set", "beam.cells=[60,60,60]", "--no-output"]
        for args, after in ((["run", BEAM, *big], 0.5),
                            (["run", BEAM, *big, "--set", 'stepper="static"'], 0.5),
                            (["view", BEAM, "--port", "0", *big[:2]], 0.5)):
            with self.subTest(args=args):
                # 0.2 s on an idle machine; tests share theirs.
                self.assertLess(self.interrupted(args, after), 2.0)

    def test_the_mesher_ends_too(self):
        mesher = self.write("mesher", "#!/bin/sh\necho $$ > id\nexec sleep 60\n")
        mesher.chmod(0o755)
        self.write("a.off", "OFF\n0 0 0\n")
        scene = self.write("s.toml", "[body.a]\nmesh = \"a.off\"\n")
        env = {**os.environ, "SINEW_MESH": str(mesher), "XDG_CACHE_HOME": str(self.dir / "cache")}
        for command in (["run", str(scene), "--no-output"], ["view", str(scene), "--port", "0"]):
            with self.subTest(command=command):
                run = subprocess.Popen([BIN, *command], cwd=self.dir, env=env,
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                told = self.dir / "id"
                while not (told.exists() and told.read_text(encoding="utf-8").endswith("\n")):
                    self.assertIsNone(run.poll())
                    time.sleep(0.02)
                process = int(told.read_text(encoding="utf-8"))
                told.unlink()
                run.send_signal(signal.SIGINT)
                self.assertEqual(run.wait(timeout=10), 130)
                deadline = time.monotonic() + 10
                while pathlib.Path(f"/proc/{process}/cmdline").exists() and \
                        pathlib.Path(f"/proc/{process}/cmdline").read_bytes():
                    self.assertLess(time.monotonic(), deadline, "the mesher goes on")
                    time.sleep(0.02)


if __name__ == "__main__":
    unittest.main()
