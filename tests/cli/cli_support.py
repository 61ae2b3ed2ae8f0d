"""Shared by the command-line tests: run the binary in a separate folder and check the result.

Each test is a unittest file; SINEW_BIN names the binary (ctest sets it).
"""

import contextlib
import os
import pathlib
import signal
import subprocess
import tempfile
import unittest
import urllib.request

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SCENES = ROOT / "scenes"
BIN = os.environ.get("SINEW_BIN", str(ROOT / "build" / "release" / "sinew"))

# Exit codes: sinew/base/error.h.
USAGE, INPUT, UNSTABLE, DIVERGED, IO = 2, 3, 4, 5, 6


class CliTest(unittest.TestCase):
    """A test with `self.dir`, an empty folder that is the commands' working folder."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="sinew-test-")
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)

    def run_sinew(self, *args, code=0, timeout=120, **options):
        """Runs `sinew ARGS`; the test fails when the exit code is not `code` (None: any).

        Returns the CompletedProcess with text stdout and stderr.
        """
        result = subprocess.run([BIN, *map(str, args)], cwd=self.dir, text=True,
                                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, timeout=timeout, **options)
        if code is not None and result.returncode != code:
            self.fail(f"sinew {' '.join(map(str, args))}: exit code {result.returncode}, "
                      f"expected {code}\n--- stdout\n{result.stdout}\n--- stderr\n{result.stderr}")
        return result

    def write(self, name, text):
        """Writes a file into the test's folder and returns its path."""
        path = self.dir / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    @contextlib.contextmanager
    def view(self, *args):
        """The address of a `sinew view` that is ended by Ctrl-C afterwards, with exit code 0."""
        process = subprocess.Popen([BIN, "view", "--port", "0", *map(str, args)], cwd=self.dir,
                                   stdout=subprocess.PIPE, text=True)
        try:
            yield process.stdout.readline().strip()
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.wait(timeout=60), 0)
        finally:
            process.kill()
            process.stdout.close()
            process.wait()

    def get(self, url, path=""):
        with urllib.request.urlopen(url + path, timeout=120) as answer:
            return answer.read().decode("utf-8", "replace")
