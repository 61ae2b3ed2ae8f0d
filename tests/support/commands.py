"""Shared by the tests that run other programs: of the installation, of the packages."""

import os
import subprocess


def run(*command, cwd=None, env=None):
    """What the command prints; SystemExit with it where it fails. `env`: added to ours."""
    done = subprocess.run([str(c) for c in command], cwd=cwd, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, env=dict(os.environ, **(env or {})),
                          check=False)
    if done.returncode:
        raise SystemExit(f"{' '.join(map(str, command))}\n{done.stdout}exit code {done.returncode}")
    return done.stdout


def check(truth, what):
    if not truth:
        raise SystemExit(f"not so: {what}")
