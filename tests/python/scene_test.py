"""sinew.Scene: tables, arrays, values as TOML."""

import math
import pathlib
import tomllib
import unittest

import numpy as np
import sinew
from python_support import SCENES, PythonTest, beam

CUBE = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], float) * 0.1
TETS = np.array([[0, 1, 3, 5], [0, 3, 2, 6], [0, 5, 6, 4], [3, 6, 5, 7], [0, 3, 6, 5]])


class SceneTest(PythonTest):
    def test_tables(self):
        scene = beam(title="a \"beam\"", gravity=np.array([0, -1.0, 0]))
        scene.region("beam", "stiff", select={"half_space": {"point": [0, 0, 0.2],
                                                             "normal": [0, 0, 1]}}, young=1e6)
        scene.ground(friction=0.3).contact(self=True).output(fps=30)
        scene["duration"] = 0.5
        text = tomllib.loads(scene.toml())
        self.assertEqual(text["title"], "a \"beam\"")
        self.assertEqual(text["gravity"], [0, -1, 0])
        self.assertEqual(text["body"]["beam"]["region"]["stiff"]["young"], 1e6)
        self.assertEqual(text["contact"], {"self": True})
        self.assertEqual(scene["duration"], 0.5)
        sim = sinew.Simulation(scene)
        self.assertEqual(list(sim.bodies), ["beam"])
        self.assertIn("beam", repr(scene))

    def test_values(self):
        scene = sinew.Scene(a=True, b=np.float32(0.5), c=np.int64(3), d=math.inf, e=["x", 1],
                            f={"k": [1.5]}, g=pathlib.Path("x/y"), h="tab\tand \\")
        text = tomllib.loads(scene.toml())
        self.assertEqual(text, {"a": True, "b": 0.5, "c": 3, "d": math.inf, "e": ["x", 1],
                                "f": {"k": [1.5]}, "g": "x/y", "h": "tab\tand \\"})
        with self.assertRaisesRegex(sinew.UsageError, "type object"):
            sinew.Scene(a=object()).toml()

    def test_files_and_texts(self):
        scene = sinew.Scene.from_file(SCENES / "liver.toml")
        scene["gravity"] = [0, 0, 0]
        sim = sinew.Simulation(scene)
        self.assertEqual(list(sim.gravity), [0, 0, 0])
        self.assertGreater(len(sim.tets), 7000)
        with self.assertRaises(sinew.InputError):
            sinew.Scene.from_text("[")

    def test_arrays(self):
        scene = sinew.Scene()
        scene.body("cube", nodes=CUBE, tets=TETS, tet_labels=[0, 0, 0, 0, 1], young=5e3)
        scene.region("cube", "middle", label=1, young=50e3)
        scene.pin("floor", select={"side": "-y"})
        scene.obstacle("lid", nodes=[[-1, 0.11, -1], [1, 0.11, -1], [1, 0.11, 1], [-1, 0.11, 1]],
                       triangles=[[0, 1, 2], [0, 2, 3]])
        sim = sinew.Simulation(scene)
        self.assertTrue(np.array_equal(sim.rest_positions, CUBE))
        self.assertEqual(len(sim.tets), 5)
        sim.advance(0.01)
        for bad, what in ((dict(nodes=CUBE), "nodes or tets"),
                          (dict(nodes=CUBE[:, :2], tets=TETS), "n x 3"),
                          (dict(nodes=CUBE, tets=TETS, tet_labels=[1]), "1 labels for 5"),
                          (dict(nodes=CUBE, tets=TETS + 5), "node"),
                          (dict(nodes=CUBE, tets=TETS + 0.5), "not all whole numbers"),
                          (dict(nodes=CUBE, tets=TETS + 2**32), "not all whole numbers"),
                          (dict(nodes=CUBE, tets=TETS * np.nan), "not all whole numbers")):
            with self.assertRaisesRegex(sinew.Error, what):
                sinew.Simulation(sinew.Scene().body("cube", **bad))

    def test_mistakes(self):
        with self.assertRaisesRegex(sinew.UsageError, "already"):
            beam().pin("wall", select={"side": "+z"})
        with self.assertRaisesRegex(sinew.UsageError, "no body 'leg'"):
            beam().region("leg", "a", label=1)
        with self.assertRaisesRegex(sinew.InputError, "did you mean 'young'"):
            sinew.Simulation(sinew.Scene().body("b", shape="box", yuong=1))


if __name__ == "__main__":
    unittest.main()
