"""Calls of the system that fail in the middle of run and resume: nothing of the user's is lost.

SINEW_FAULTS names the library of faults.cpp, which makes them fail.
"""

import json
import os
import shutil
import unittest

from cli_support import IO, CliTest

FAULTS = os.environ.get("SINEW_FAULTS", "")
INTERNAL = 1
SCENE = """duration = 0.05
[output]
fps = 60
checkpoint = 0
[body.b]
shape = "beam"
cells = [2, 2, 4]
[pin.wall]
select = { side = "-z" }
[probe.tip]
select = { side = "+z" }
"""


@unittest.skipIf(not FAULTS, "needs the library faults")
class FaultsTest(CliTest):
    def setUp(self):
        super().setUp()
        self.write("s.toml", SCENE)
        whole = self.run_sinew("run", "s.toml", "--out", "whole", "--json", "--quiet")
        self.hash = json.loads(whole.stdout)["state_hash"]

    def with_fault(self, fault, *args):
        environment = {**os.environ, "LD_PRELOAD": FAULTS, "SINEW_FAULT": fault}
        return self.run_sinew(*args, code=None, env=environment)

    # The command ends by itself, with a reason and the remedy or place, and no half-written frame.
    def check_failure(self, fault, result, codes):
        told = f"{fault}: code {result.returncode}\n{result.stdout}\n{result.stderr}"
        self.assertIn(result.returncode, codes, told)
        self.assertIn("sinew: ", result.stderr, told)
        left = [f.name for f in (self.dir / "o").rglob("*.tmp")] if (self.dir / "o").exists() else []
        self.assertEqual(left, [], told)

    # Every call of a kind in turn, until the command no longer gets to it.
    def every(self, kind, codes, step=1, onward=""):
        failed = 0
        for n in range(1, 400, step):
            shutil.rmtree(self.dir / "o", ignore_errors=True)
            fault = f"{kind}:{n}{onward}"
            result = self.with_fault(fault, "run", "s.toml", "--out", "o", "--quiet", "--json")
            if result.returncode == 0:
                if json.loads(result.stdout)["state_hash"] != self.hash:
                    self.fail(f"{fault}: another result")
                return failed
            failed += 1
            self.check_failure(fault, result, codes)
            self.finish(fault)
        return failed

    # A run that was stopped by a fault goes on, or says that there is nothing to go on from and can
    # be run again.
    def finish(self, fault):
        again = self.run_sinew("resume", "o", "--json", "--quiet", code=None)
        if again.returncode != 0:
            self.assertIn("sinew: ", again.stderr, fault)
            self.assertFalse((self.dir / "o" / "checkpoint.bin").exists(), f"{fault}: {again.stderr}")
            again = self.run_sinew("run", "s.toml", "--out", "o", "--force", "--json", "--quiet")
        self.assertEqual(json.loads(again.stdout)["state_hash"], self.hash, fault)

    def test_a_file_that_cannot_be_opened(self):
        self.assertGreater(self.every("open", {IO}), 10)

    def test_a_full_disk(self):
        self.assertGreater(self.every("write", {IO}), 10)
        self.every("write", {IO}, step=3, onward="+")

    def test_a_disk_that_does_not_sync(self):
        self.assertGreater(self.every("sync", {IO}), 3)

    def test_a_file_that_cannot_be_renamed(self):
        self.assertGreater(self.every("rename", {IO}), 10)

    def test_no_memory(self):
        self.assertGreater(self.every("memory", {INTERNAL, IO}, step=7), 3)

    def test_resume(self):
        self.run_sinew("run", "s.toml", "--out", "half", "--set", "duration=0.034", "--quiet")
        scene = self.dir / "half" / "scene.toml"
        scene.write_text(scene.read_text().replace("0.034", "0.05"))
        shutil.copytree(self.dir / "half", self.dir / "o")
        right = json.loads(self.run_sinew("resume", "o", "--quiet", "--json").stdout)["state_hash"]
        failed = 0
        for kind in ("open", "write", "sync", "rename", "memory"):
            for n in range(1, 40, 4):
                shutil.rmtree(self.dir / "o")
                shutil.copytree(self.dir / "half", self.dir / "o")
                fault = f"{kind}:{n}"
                result = self.with_fault(fault, "resume", "o", "--quiet", "--json")
                if result.returncode != 0:
                    failed += 1
                    self.check_failure(fault, result, {INTERNAL, IO})
                    result = self.run_sinew("resume", "o", "--json", "--quiet")
                self.assertEqual(json.loads(result.stdout)["state_hash"], right, fault)
        self.assertGreater(failed, 10)


if __name__ == "__main__":
    unittest.main()
