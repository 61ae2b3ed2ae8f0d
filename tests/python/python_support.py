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


def cube(side=0.02, cells=3, poisson=0.45):
    """A cube between two glued plates."""
    scene = sinew.Scene(gravity=[0, 0, 0])
    scene.body("cube", shape="box", size=[side] * 3, cells=[cells] * 3, young=8e3, poisson=poisson)
    scene.pin("floor", select={"side": "-y"})
    scene.pin("plate", select={"side": "+y"}, path=[{"time": 0}])
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
