"""sinew.calibrate: synthetic data, confidence, identifiability, a published curve."""

import importlib.util
import math
import unittest

import numpy as np
import sinew
from python_support import PythonTest, cube
from sinew.calibration import calibrate, read_curve
from sinew.calibration.fit import _Curve
from sinew.study import Range

YOUNG = Range(1e3, 50e3, log=True)


PRESS = dict(moved="pin.plate", direction=[0, -1, 0])


@unittest.skipIf(importlib.util.find_spec("scipy") is None, "scipy is not installed")
class CalibrateTest(PythonTest):
    def curve(self, scene, displacement, point, direction=(0, -1, 0)):
        return _Curve(scene, "pin.plate", direction, [], displacement).force(point)

    def test_exact_data(self):
        d = np.linspace(0.2e-3, 2e-3, 6)
        force = self.curve(cube(), d, {"cube.young": 12e3})
        self.assertGreater(force[0], 0.0)
        found = calibrate(cube(), (d, force), parameters={"cube.young": YOUNG}, **PRESS)
        estimate = found.estimates["cube.young"]
        self.assertLess(abs(estimate.value / 12e3 - 1), 1e-4)
        self.assertLessEqual(estimate.low, estimate.value)
        self.assertEqual(found.warnings, [])
        self.assertIn("cube.young: 12000", str(found))

    # With 2 % noise the interval holds the true value 95 times of 100. Three standard deviations of
    # that count: 88.5.
    def test_coverage(self):
        d = np.linspace(0.2e-3, 2e-3, 8)
        exact = self.curve(cube(cells=2), d, {"cube.young": 12e3})
        random = np.random.default_rng(7)
        held = 0
        for _ in range(100):
            noisy = exact + 0.02 * exact.max() * random.standard_normal(len(exact))
            e = calibrate(cube(cells=2), (d, noisy), parameters={"cube.young": YOUNG},
                          **PRESS).estimates["cube.young"]
            held += e.low <= 12e3 <= e.high
        self.assertGreaterEqual(held, 89)

    # A long bar that is free at its sides: the force tells Young's modulus, not Poisson's ratio.
    def test_what_the_data_do_not_determine_is_said(self):
        scene = sinew.Scene(gravity=[0, 0, 0])
        scene.body("bar", shape="box", size=[0.01, 0.1, 0.01], cells=[2, 12, 2], young=8e3,
                   poisson=0.3)
        scene.pin("floor", select={"side": "-y"})
        scene.pin("plate", select={"side": "+y"}, path=[{"time": 0}])
        d = np.linspace(0.5e-3, 3e-3, 8)
        exact = self.curve(scene, d, {"bar.young": 12e3}, (0, 1, 0))
        noisy = exact * (1 + 0.02 * np.random.default_rng(3).standard_normal(len(exact)))
        found = calibrate(scene, (d, noisy), moved="pin.plate", direction=[0, 1, 0],
                          parameters={"bar.young": YOUNG, "bar.poisson": Range(0.05, 0.45)})
        self.assertTrue(any("do not determine bar.poisson" in w for w in found.warnings),
                        found.warnings)
        young = found.estimates["bar.young"]
        self.assertTrue(young.low <= 12e3 <= young.high, young)

    # Cortex in shear (Budday et al. 2017, see validation/brain), up to 10 %.
    def test_a_published_curve(self):
        shear = np.array([0.0249, 0.0498, 0.0751, 0.1])
        stress = np.array([36.3, 68.1, 102.15, 145.1])  # [Pa]
        file = self.write("shear.csv", "displacement [m],force [N]\n" + "".join(
            f"{0.005 * g},{25e-6 * s}\n" for g, s in zip(shear, stress)))
        self.assertEqual(len(read_curve(file)[0]), 4)
        found = calibrate(cube(side=0.005, cells=6, poisson=0.49), file, moved="pin.plate",
                          direction=[1, 0, 0], parameters={"cube.young": YOUNG})
        e = found.estimates["cube.young"]
        self.assertTrue(5e3 < e.low < e.value < e.high < 6.5e3, e)
        self.assertLess(found.noise / found.measured.max(), 0.05)
        if importlib.util.find_spec("matplotlib") is not None:
            found.plot(self.dir / "shear.png")
            self.assertGreater((self.dir / "shear.png").stat().st_size, 5000)

    def test_an_indenter(self):
        scene = sinew.Scene(gravity=[0, 0, 0])
        scene.body("slab", shape="box", size=[0.06, 0.02, 0.06], cells=[6, 3, 6], young=8e3)
        scene.pin("floor", select={"side": "-y"})
        scene.obstacle("ball", shape="sphere", center=[0, 0.0201, 0], radius=0.01,
                       path=[{"time": 0}])
        d = np.linspace(1e-3, 3e-3, 4)
        force = _Curve(scene, "obstacle.ball", [0, -1, 0], [], d).force({"slab.young": 12e3})
        self.assertTrue((np.diff(force) > 0).all(), force)
        found = calibrate(scene, (d, force), moved="obstacle.ball", direction=[0, -1, 0],
                          parameters={"slab.young": YOUNG})
        self.assertLess(abs(found.estimates["slab.young"].value / 12e3 - 1), 0.01)

    def test_mistakes(self):
        d = np.array([1e-3, 2e-3])
        for bad in (dict(data=(d, d[:1])), dict(moved="plate"), dict(direction=[0, 0, 0]),
                    dict(parameters={}), dict(data=(d, d * math.nan)),
                    dict(parameters={"cube.young": YOUNG, "cube.poisson": Range(0.1, 0.4)})):
            with self.assertRaises(sinew.UsageError):
                calibrate(**{**dict(scene=cube(), data=(d, d), parameters={"cube.young": YOUNG},
                                    **PRESS), **bad})
        with self.assertRaisesRegex(sinew.InputError, "yuong"):
            calibrate(cube(), (d, d), parameters={"cube.yuong": YOUNG}, **PRESS)
        with self.assertRaisesRegex(sinew.UsageError, ":2: no force"):
            read_curve(self.write("bad.csv", "d,f\n1e-3\n"))


if __name__ == "__main__":
    unittest.main()
