"""sinew.Simulation: cuts, blades, undo."""

import unittest

import numpy as np
import sinew
from python_support import BEAM, PythonTest


class Cuts(PythonTest):
    def test_a_plane_parts_the_beam_and_undo_brings_it_back(self):
        sim = sinew.Simulation(BEAM)
        sim.advance(0.02)
        before, positions, tets = sim.hash(), sim.positions, sim.tets
        topology = sim.topology
        report = sim.cut(plane=([0, 0, 0.2], [0.1, 0, 1]))
        self.assertIsInstance(report, sinew.CutReport)
        self.assertGreater(report.opened, 4)
        self.assertEqual((report.parts_before, report.parts), (1, 2))
        self.assertLessEqual(report.elastic, report.elastic_before)
        self.assertEqual(len(sim.positions), len(positions) + report.new_nodes)
        self.assertEqual(len(sim.tets), len(tets) + report.new_tets)
        self.assertEqual(len(sim.stress), len(sim.tets))
        self.assertNotEqual(sim.topology, topology)
        self.assertEqual([e.kind for e in sim.take_events()], ["parted"])
        self.assertTrue(sim.can_undo)
        sim.undo()
        self.assertEqual(sim.hash(), before)
        sim.redo()
        self.assertEqual(len(sim.tets), len(tets) + report.new_tets)
        sim.advance(0.02)

    def test_every_surface_and_a_blade(self):
        plane = sinew.Simulation(BEAM).cut(plane=([0, 0, 0.2], [0, 0, 1])).opened
        for keys in ({"disc": ([0, 0, 0.2], [0, 0, 1], 1.0)},
                     {"blade": [([0.1, 0.1, 0.2], [0.1, -0.1, 0.2]), ([-0.1, 0.1, 0.2], [-0.1, -0.1, 0.2])]},
                     {"triangles": (np.array([[-1, -1, 0.2], [1, -1, 0.2], [0, 2, 0.2]]), [[0, 1, 2]])},
                     {"plane": ([0, 0, 0.2], [0, 0, 1]), "at_rest": True}):
            self.assertEqual(sinew.Simulation(BEAM).cut(**keys).opened, plane, keys)
        sim = sinew.Simulation(BEAM)
        blade = sim.blade()
        opened = 0
        for x in np.linspace(0.08, -0.08, 9):
            opened += blade.move([x, 0.08, 0.2], [x, -0.08, 0.2]).opened
            sim.advance(0.002)
        self.assertEqual(opened, plane)
        blade.lift()
        sim.undo()
        self.assertFalse(sim.can_undo)
        blade.remove()
        with self.assertRaisesRegex(sinew.UsageError, "blade"):
            blade.lift()

    def test_arrays_follow_the_cuts_of_a_scene(self):
        sim = sinew.Simulation(BEAM + """
[cut.middle]
time = 0.03
plane = { point = [0, 0, 0.2], normal = [0, 0, 1] }
at_rest = true
""")
        nodes = len(sim.positions)
        sim.advance(0.1)
        self.assertGreater(len(sim.positions), nodes)
        self.assertEqual(len(sim.positions), len(sim.velocities))
        self.assertLess(sim.tets.max(), len(sim.positions))

    def test_mistakes(self):
        sim = sinew.Simulation(BEAM)
        for keys in ({}, {"plane": ([0, 0, 0], [0, 0, 1]), "disc": ([0, 0, 0], [0, 0, 1], 1.0)}):
            with self.assertRaisesRegex(sinew.UsageError, "one surface"):
                sim.cut(**keys)
        with self.assertRaises(sinew.InputError):
            sim.cut(plane=([0, 0, 0], [0, 0, 0]))
        with self.assertRaises(sinew.Error):
            sim.cut(plane=([0, 0, float("nan")], [0, 0, 1]))
        with self.assertRaisesRegex(sinew.Error, "bean"):
            sim.cut(body="bean", plane=([0, 0, 0], [0, 0, 1]))
        with self.assertRaises(sinew.UsageError):
            sim.undo()


if __name__ == "__main__":
    unittest.main()
