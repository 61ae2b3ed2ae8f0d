"""Shared by the tests of the Python package: small scenes, an empty folder."""

import pathlib
import tempfile
import unittest

import sinew

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SCENES = ROOT / "scenes"

BEAM = """gravity = [0, -9.81, 0]
[body.beam]
shape = "beam"
cells = [2, 2, 8]
young = 150e3
poisson = 0.45
[pin.wall]
select = { side = "-z" }
[probe.tip]
select = { side = "+z" }
"""


def beam(**keys):
    scene = sinew.Scene(**keys)
    scene.body("beam", shape="beam", cells=[2, 2, 8], young=150e3, poisson=0.45)
    scene.pin("wall", select={"side": "-z"})
    scene.probe("tip", select={"side": "+z"})
    return scene


class PythonTest(unittest.TestCase):
    """A test with `self.dir`, an empty folder."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="sinew-python-")
        self.addCleanup(folder.cleanup)
        self.dir = pathlib.Path(folder.name)

    def write(self, name, text):
        path = self.dir / name
        path.write_text(text, encoding="utf-8")
        return path
