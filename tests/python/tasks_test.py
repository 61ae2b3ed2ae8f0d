"""run, resume, static, identify, converge, validate."""

import unittest

import numpy as np
import sinew
from python_support import BEAM, ROOT, PythonTest, beam


class TasksTest(PythonTest):
    def test_run(self):
        seen = []
        result = sinew.run(beam(duration=0.1), out=self.dir / "o",
                           progress=lambda share, left: seen.append(share))
        self.assertEqual(result.status, "finished")
        self.assertAlmostEqual(result.time, 0.1)
        self.assertEqual(seen, sorted(seen))
        self.assertAlmostEqual(seen[-1], 1.0)
        table = result.table()
        self.assertEqual(len(table["time [s]"]), result.frames + 1)
        self.assertLess(table["tip.uy [m]"].min(), -1e-3)
        self.assertIn("kinetic [J]", result.table("energy"))
        with self.assertRaisesRegex(sinew.UsageError, "run"):
            sinew.run(beam(duration=0.1), out=self.dir / "o")
        again = sinew.run(beam(duration=0.1), out=self.dir / "o", force=True, threads=1)
        self.assertEqual(again.state_hash, result.state_hash)
        self.assertEqual(sinew.run(beam(duration=0.1)).state_hash, result.state_hash)
        with self.assertRaises(sinew.UsageError):
            sinew.run(beam(duration=0.01)).table()

    def test_an_exception_in_progress_ends_the_run_which_can_be_resumed(self):
        def stop(share, left):
            if share > 0.4:
                raise RuntimeError("enough")
        right = sinew.run(beam(duration=0.2))
        scene = beam(duration=0.2)
        scene.output(checkpoint=0)
        with self.assertRaisesRegex(RuntimeError, "enough"):
            sinew.run(scene, out=self.dir / "o", progress=stop)
        self.assertEqual(sinew.resume(self.dir / "o").state_hash, right.state_hash)

    def test_static(self):
        sim = sinew.static(beam(), set={"beam.young": 1.5e6, "beam.cells": [4, 4, 16]})
        tip = sim.probes["tip"].displacement[1]
        self.assertLess(abs(tip / -0.0271 - 1), 0.03)  # validation/beam
        weight = sim.bodies["beam"].mass * 9.81
        self.assertAlmostEqual(sim.pin("wall").force[1] / -weight, 1.0, 3)
        stretched = beam(duration=2, gravity=[0, 0, 0])
        stretched.pin("end", select={"side": "+z"},
                      path=[{"time": 0}, {"time": 2, "move": [0, 0, 0.04]}])
        self.assertGreater(sinew.static(stretched).pin("wall").force[2], 0.0)

    def test_identify(self):
        found = sinew.identify(beam(), laws=["neo-hookean", "vangelder"], curve=True)
        law = found["neo-hookean"]
        self.assertLess(abs(law.displacement.young / 150e3 - 1), 0.01)
        self.assertEqual(law.displacement.young_along.shape, (3,))
        self.assertEqual(law.stress.shape, law.stretch.shape)
        with self.assertRaises(sinew.UsageError):
            sinew.identify(beam(), laws=["hooke"])

    def test_converge(self):
        file = self.write("beam.toml", BEAM + "\n")
        result = sinew.converge(file, levels=2, set={"stepper": "static"})
        self.assertEqual(len(result.tets), 2)
        self.assertEqual(result.trends["tip"].displacement.shape, (2, 3))
        self.assertTrue(np.isfinite(result.trends["tip"].extrapolated).all())

    def test_validate(self):
        result = sinew.validate("uniaxial", folder=ROOT / "validation", quick=True,
                                laws=["neo-hookean"])
        self.assertTrue(result.holds)
        self.assertIn("cases", result.report)


if __name__ == "__main__":
    unittest.main()
