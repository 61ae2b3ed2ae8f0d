"""sinew.Simulation: steps, arrays, handles, states, threads, Ctrl-C."""

import gc
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time
import unittest
import weakref

import numpy as np
import sinew
from python_support import BEAM, SCENES, PythonTest, beam

TOOL = """gravity = [0, 0, 0]
[body.slab]
shape = "box"
size = [0.1, 0.02, 0.1]
cells = [6, 2, 6]
young = 5e3
[pin.bottom]
select = { side = "-y" }
[obstacle.tool]
shape = "sphere"
center = [0, 0.031, 0]
radius = 0.02
"""


class Time(PythonTest):
    def test_from_path_text_and_scene_are_the_same(self):
        of_text = sinew.Simulation(BEAM)
        of_file = sinew.Simulation(self.write("beam.toml", BEAM))
        of_scene = sinew.Simulation(beam(gravity=[0, -9.81, 0]))
        hashes = set()
        for sim in (of_text, of_file, of_scene):
            self.assertTrue(sim.advance(0.05))
            hashes.add(sim.hash())
        self.assertEqual(len(hashes), 1)

    def test_mistakes_of_a_call(self):
        for threads in (-1, 5000):
            with self.assertRaisesRegex(sinew.UsageError, "threads"):
                sinew.Simulation(BEAM, threads=threads)
            with self.assertRaisesRegex(sinew.UsageError, "threads"):
                sinew.run(BEAM, threads=threads)
        sim = sinew.Simulation(BEAM)
        for place in ([1, 2], "up", None, 3.0):
            with self.assertRaisesRegex(sinew.UsageError, "three numbers"):
                sim.nearest_node(place)

    def test_threads_do_not_change_the_bits(self):
        hashes = set()
        for threads in (1, 2):
            sim = sinew.Simulation(SCENES / "beam.toml", threads=threads)
            sim.advance(0.02)
            hashes.add(sim.hash())
        self.assertEqual(len(hashes), 1)

    def test_time_and_steps(self):
        sim = sinew.Simulation(BEAM)
        self.assertEqual((sim.time, sim.steps, sim.stepper), (0.0, 0, "verlet"))
        sim.step()
        self.assertEqual(sim.steps, 1)
        self.assertEqual(sim.time, sim.last_step)
        sim.step(1e-4)
        self.assertAlmostEqual(sim.last_step, 1e-4, 15)
        with self.assertRaisesRegex(sinew.UnstableError, "remedy"):
            sim.step(1.0)
        self.assertGreater(sim.stable_step, 1e-4)

    def test_settings(self):
        def tip(settings):
            sim = sinew.Simulation(BEAM, set=settings)
            sim.advance(0.1)
            return sim.probes["tip"].displacement[1]
        for settings in ({"beam.young": 15e6}, ["beam.young=15e6"]):
            self.assertGreater(tip(settings), 0.5 * tip(None))


class Arrays(PythonTest):
    def test_shapes_and_types(self):
        sim = sinew.Simulation(BEAM)
        nodes, tets = len(sim.positions), len(sim.tets)
        for array, shape, kind in ((sim.positions, (nodes, 3), np.float64),
                                   (sim.rest_positions, (nodes, 3), np.float64),
                                   (sim.velocities, (nodes, 3), np.float64),
                                   (sim.forces, (nodes, 3), np.float64),
                                   (sim.stress, (tets, 6), np.float64),
                                   (sim.masses, (nodes,), np.float64),
                                   (sim.tets, (tets, 4), np.int32)):
            self.assertEqual((array.shape, array.dtype), (shape, kind))
            with self.assertRaises(ValueError):
                array[0] = 0
        self.assertEqual(sim.surface.shape[1], 3)
        self.assertLess(sim.tets.max(), nodes)
        self.assertAlmostEqual(sim.masses.sum(), sim.bodies["beam"].mass, 9)
        self.assertEqual(sim.bodies["beam"].nodes, slice(0, nodes))

    def test_an_array_follows_the_simulation(self):
        sim = sinew.Simulation(BEAM)
        x = sim.positions
        tip = x[-4:]  # a view of it
        before = x.copy()
        sim.advance(0.05)
        self.assertLess(x[:, 1].min(), before[:, 1].min() - 1e-3)
        self.assertTrue(np.shares_memory(x, sim.positions))
        self.assertTrue(np.array_equal(tip, sim.positions[-4:]))
        self.assertTrue(np.array_equal(sim.displacements, x - before))

    def test_an_array_outlives_the_simulation(self):
        sim = sinew.Simulation(BEAM)
        x = sim.positions
        copy = x.copy()
        del sim
        gc.collect()
        self.assertTrue(np.array_equal(x, copy))

    def test_after_a_change_of_the_model_old_arrays_keep_their_values(self):
        sim = sinew.Simulation(BEAM)
        sim.advance(0.02)
        x = sim.positions
        before = x.copy()
        sim.material("beam").change(young=30e3)
        sim.advance(0.05)
        self.assertTrue(np.array_equal(x, before))
        self.assertFalse(np.shares_memory(x, sim.positions))
        self.assertGreater(np.abs(sim.positions - before).max(), 1e-3)

    def test_stress_of_a_hanging_bar(self):
        scene = sinew.Scene(gravity=[0, 0, -9.81])
        scene.body("bar", shape="beam", cells=[2, 2, 8], young=150e3, poisson=0.0, density=1000)
        scene.pin("wall", select={"side": "+z"})
        sim = sinew.static(scene)
        middle = sim.positions[sim.tets].mean(axis=1)[:, 2]
        below = middle - sim.positions[:, 2].min()
        near = np.abs(below - 0.2) < 0.03
        self.assertAlmostEqual(sim.stress[near, 2].mean() / (1000 * 9.81 * below[near].mean()), 1.0, 1)

    @unittest.skipIf("SINEW_SANITIZED" in os.environ, "a sanitizer keeps freed memory")
    def test_no_leak(self):
        def resident():
            with open("/proc/self/statm", encoding="ascii") as file:
                return int(file.read().split()[1])
        def round_of():
            sim = sinew.Simulation("[body.b]\nshape = \"box\"\ncells = [1, 1, 1]\n"
                                   "[pin.p]\nselect = { side = \"-y\" }\n", threads=1)
            _ = (sim.positions, sim.velocities, sim.stress)
            sim.step()
            return sim
        for _ in range(300):
            round_of()
        before = resident()
        for _ in range(1000):
            round_of()
        self.assertLess(resident() - before, 1000)  # pages
        sim = round_of()
        gone = weakref.ref(sim)
        del sim
        self.assertIsNone(gone())


class Handles(PythonTest):
    def test_a_tool_presses_a_slab(self):
        sim = sinew.Simulation(TOOL)
        tool = sim.obstacle("tool")
        self.assertEqual(sim.obstacle_names, ["tool"])
        for i in range(20):
            tool.move([0, 0.031 - 3e-4 * i, 0])
            sim.advance(1e-3)
        self.assertGreater(tool.force[1], 0.0)
        self.assertTrue(tool.contacts())
        self.assertAlmostEqual(tool.pose.center[1], 0.031 - 3e-4 * 19)
        force, torque = tool.wrench()
        self.assertEqual((force.shape, torque.shape), ((3,), (3,)))
        node = sim.nearest_node([0, 0.01, 0])
        self.assertLess(sim.positions[node, 1], 0.01)
        pressed = sim.pin("bottom").force
        self.assertLess(pressed[1], 0.0)
        with self.assertRaisesRegex(sinew.UsageError, "tool"):
            sim.obstacle("toll")

    def test_obstacles_are_added_and_removed(self):
        sim = sinew.Simulation(TOOL)
        other = sim.add_obstacle("ball", shape="sphere", center=[0.03, 0.025, 0], radius=0.01)
        self.assertEqual(sim.obstacle_names, ["tool", "ball"])
        other.place([0.03, 0.05, 0])
        sim.advance(0.01)
        self.assertEqual(other.depth, 0.0)
        other.remove()
        self.assertEqual(sim.obstacle_names, ["tool"])
        with self.assertRaises(sinew.UsageError):
            other.move([0, 0, 0])
        with self.assertRaisesRegex(sinew.UsageError, "unknown key 'radios'"):
            sim.add_obstacle("bad", radios=1)

    def test_a_pin_moves(self):
        sim = sinew.Simulation(BEAM)
        wall = sim.pin("wall")
        wall.move([0, 0.01, 0], [0, 0, 0.1])
        sim.advance(0.05)
        self.assertAlmostEqual(wall.motion.move[1], 0.01)
        self.assertAlmostEqual(wall.motion.turn[2], 0.1)

    def test_a_grab_pulls(self):
        sim = sinew.Simulation(BEAM, set={"gravity": [0, 0, 0]})
        node = sim.nearest_node([0, 0, 0.4])
        grab = sim.grab(node, 0.03)
        grab.move([0, 0.05, 0.4])
        sim.advance(0.2)
        self.assertGreater(sim.positions[node, 1], 0.01)
        self.assertGreater(np.linalg.norm(grab.force), 0.0)
        grab.release()
        with self.assertRaises(sinew.UsageError):
            grab.move([0, 0, 0])

    def test_gravity_and_materials(self):
        sim = sinew.Simulation(BEAM)
        sim.gravity = [0, 0, -9.81]
        self.assertEqual(list(sim.gravity), [0, 0, -9.81])
        with self.assertRaises(sinew.InputError):
            sim.material("beam").change(young=-1)
        with self.assertRaises(sinew.UsageError):
            sim.material("leg")


class States(PythonTest):
    def test_save_and_restore(self):
        sim = sinew.Simulation(BEAM)
        sim.advance(0.02)
        state = sim.save()
        sim.advance(0.03)
        right = sim.hash()
        sim.restore(state)
        sim.advance(0.03)
        self.assertEqual(sim.hash(), right)
        other = sinew.Simulation(BEAM)
        other.restore(state)
        other.advance(0.03)
        self.assertEqual(other.hash(), right)
        with self.assertRaises(sinew.InputError):
            sim.restore(state[:100])

    def test_arrays_after_a_change_are_whole(self):
        sim = sinew.Simulation(BEAM)
        before = sim.positions
        shape = before.shape
        state = sim.save()
        sim.advance(0.02)
        sim.restore(state)
        self.assertEqual(sim.positions.shape, shape)
        np.testing.assert_array_equal(sim.positions, sim.rest_positions)
        sim.material("beam").change(young=100e3)
        self.assertEqual(sim.positions.shape, shape)
        self.assertEqual(sim.velocities.shape, shape)

    def test_errors_have_place_and_remedy(self):
        with self.assertRaises(sinew.InputError) as caught:
            sinew.Simulation(self.write("bad.toml", BEAM.replace("0.45", "0.7")))
        error = caught.exception
        self.assertEqual((error.line, error.column), (6, 11))
        self.assertTrue(error.file.endswith("bad.toml"))
        self.assertIn("poisson", error.message)
        self.assertTrue(error.remedy)
        self.assertIn("remedy: ", str(error))
        self.assertIsInstance(error, ValueError)
        with self.assertRaises(sinew.IoError):
            sinew.Simulation("missing.toml")


class Threads(PythonTest):
    def test_another_thread_reads_during_a_step_and_interrupts(self):
        sim = sinew.Simulation(SCENES / "liver.toml")
        x = sim.positions
        seen = []
        def watch():
            for _ in range(20):
                seen.append(np.isfinite(x).all())
                time.sleep(0.005)
            sim.interrupt()
        watcher = threading.Thread(target=watch)
        watcher.start()
        self.assertFalse(sim.advance(100))
        watcher.join()
        self.assertTrue(all(seen))
        self.assertTrue(sim.advance(0.001))

    def test_two_threads_at_once_are_refused(self):
        sim = sinew.Simulation(SCENES / "liver.toml")
        errors = []
        def step():
            time.sleep(0.05)
            try:
                sim.step()
            except sinew.UsageError as error:
                errors.append(error)
            sim.interrupt()
        other = threading.Thread(target=step)
        other.start()
        sim.advance(100)
        other.join()
        self.assertEqual(len(errors), 1)

    def test_ctrl_c(self):
        code = textwrap.dedent(f"""
            import sinew
            sim = sinew.Simulation({str(SCENES / 'liver.toml')!r})
            sim.step()
            print("ready", flush=True)
            try:
                sim.advance(1000)
            except KeyboardInterrupt:
                print("stopped", flush=True)
            time = sim.time
            print("steps", flush=True)
            try:  # explicit steps do not look at interrupt()
                while True:
                    sim.step()
            except KeyboardInterrupt:
                pass
            print("goes on", sim.advance(0.001), sim.time > time)
        """)
        child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True,
                                 env=os.environ)
        self.assertEqual(child.stdout.readline(), "ready\n")
        time.sleep(0.3)
        start = time.monotonic()
        child.send_signal(signal.SIGINT)
        self.assertEqual(child.stdout.readline(), "stopped\n")
        self.assertEqual(child.stdout.readline(), "steps\n")
        time.sleep(0.3)
        child.send_signal(signal.SIGINT)
        self.assertEqual(child.stdout.read(), "goes on True True\n")
        self.assertLess(time.monotonic() - start, 20)
        child.stdout.close()
        self.assertEqual(child.wait(), 0)


if __name__ == "__main__":
    unittest.main()
