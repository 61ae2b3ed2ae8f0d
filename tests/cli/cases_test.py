"""Scenes whose right value is known independently (tests/data/truth, tests/data/behaviour).

The right values come from formulas, from quadratic tetrahedra with the same energy (CalculiX), or
from conservation laws. The bounds are what the meshes of these scenes reach.
"""

import csv
import json
import math
import unittest

from cli_support import DIVERGED, ROOT, UNSTABLE, CliTest

DATA = ROOT / "tests" / "data"


class CaseTest(CliTest):
    def summary(self, scene, *settings, code=0):
        sets = [word for setting in settings for word in ("--set", setting)]
        result = self.run_sinew("run", DATA / scene, "--no-output", "--json", *sets, code=code)
        return json.loads(result.stdout)

    def near(self, value, right, share):
        self.assertLessEqual(abs(value / right - 1.0), share, f"{value} instead of {right}")


class Truth(CaseTest):
    def tip(self, poisson, cells):
        s = self.summary("truth/w4.toml", f"beam.poisson={poisson}",
                         f"beam.cells=[{cells},{cells},{4 * cells}]")
        return -s["probes"]["tip"]["displacement"][1]

    def test_tip_of_the_clamped_bar(self):
        for poisson, right, of_4, of_8 in ((0.0, 0.02786, 0.025, 0.008),
                                           (0.45, 0.02710, 0.024, 0.008),
                                           (0.499, 0.02681, 0.037, 0.012)):
            self.near(self.tip(poisson, 4), right, of_4)
            self.near(self.tip(poisson, 8), right, of_8)

    # The force of the bonded cube from the work of its top plate.
    def press(self, scene, poisson):
        def elastic(move):
            path = f"pin.top.path=[{{time=0}},{{time=1,move=[0,{-move},0]}}]"
            return self.summary(scene, path, f"b.poisson={poisson}")["energy"]["elastic"]
        return (elastic(0.0101) - elastic(0.0099)) / 0.0002

    def test_bonded_cube_does_not_lock(self):
        self.near(self.press("truth/compress-4.toml", 0.45), 12.92, 0.02)
        self.near(self.press("truth/compress-4.toml", 0.499), 13.76, 0.07)

    def test_two_materials(self):
        for poisson, right, share in ((0.0, 5.79e-3, 0.06), (0.45, 5.66e-3, 0.02)):
            s = self.summary("truth/bar-parallel.toml", f"b.poisson={poisson}",
                             f"b.region.r2.poisson={poisson}")
            self.near(math.hypot(*s["probes"]["tip"]["displacement"]), right, share)
        s = self.summary("truth/nu-press-4.toml")
        self.near(s["probes"]["mid"]["displacement"][1], -5.70e-3, 0.055)


class Outputs(CaseTest):
    # The wall bears the whole weight, rho V g.
    def test_the_force_on_a_pin(self):
        s = self.summary("truth/w4.toml")
        self.near(-s["pins"]["wall"]["force"][1], 41.594, 1e-4)

    # Uniaxial strain by 4 % at E = 10 kPa: Cauchy stresses of the stable neo-Hookean law.
    def test_the_stress_of_a_uniform_strain(self):
        try:
            import meshio
        except ImportError:
            self.skipTest("meshio is not installed")
        for poisson, pressure, axial in ((0, 127.78, -400.0), (0.3, 329.06, -538.46)):
            self.run_sinew("run", DATA / "truth/uni.toml", "--set", f"b.poisson={poisson}",
                           "--out", "o", "--force")
            mesh = meshio.read(self.dir / "o/frames/uni_0001.vtu")
            for of_tet in mesh.cell_data["pressure"][0]:
                self.near(of_tet, pressure, 1e-4)
            for of_tet in mesh.cell_data["stress"][0]:
                self.near(of_tet[1], axial, 1e-4)
                self.assertLess(max(map(abs, of_tet[3:])), 0.01)


class Sheets(CaseTest):
    def test_a_free_plate_stays_as_it_is(self):
        s = self.summary("behaviour/sheet-free.toml")
        self.assertGreaterEqual(s["energy"]["elastic"], -1e-12)
        self.assertLess(s["peak_stretch"], 1e-6)

    def test_a_plate_that_is_hardly_touched_stays(self):
        s = self.summary("behaviour/sheet-unstable.toml", "duration=0.5")
        self.assertLess(s["peak_stretch"], 1e-5)

    # Between rho g L^4 / (8 E h^2 / 12) = 3.18 mm (beam) and (1 - nu^2) of it (plate).
    def test_a_strip_bends_as_a_plate(self):
        s = self.summary("behaviour/sheet.toml", "gravity=[0,-0.005,0]", "s.cells=[25,2,100]")
        tip = -s["probes"]["tip"]["displacement"][1]
        self.assertGreater(tip, 0.9 * 2.89e-3)
        self.assertLess(tip, 1.1 * 3.18e-3)


class Impacts(CaseTest):
    def closes(self, s):
        e = s["energy"]
        self.assertLess(e["peak_drift"], 0.01 * e["peak"])

    def test_a_ball_that_bounces_makes_no_energy(self):
        self.closes(self.summary("behaviour/bounce.toml"))
        for restitution in (0, 0.5, 0.8, 1):
            s = self.summary("behaviour/bounce-energy.toml", f"ground.restitution={restitution}")
            self.closes(s)
            e = s["energy"]
            self.assertLess(e["kinetic"] + e["elastic"] + e["gravity"], 1e-3)

    def test_a_dropped_cube_makes_no_energy(self):
        s = self.summary("truth/cube-drop.toml")
        self.closes(s)
        self.assertLess(s["energy"]["drift"], 0.0104)

    # An elastic blow of a rod at v gives a block of mass m at most 2 m v^2.
    def test_a_fast_tool(self):
        s = self.summary("behaviour/fast-tool.toml",
                         "obstacle.rod.path=[{time=0},{time=0.5,move=[1.0,0,0]}]")
        self.assertLess(s["energy"]["kinetic"], 2 * 0.229 * 2**2)
        self.closes(s)
        for speed in (4, 10, 20):
            path = f"obstacle.rod.path=[{{time=0}},{{time={1 / speed},move=[1.0,0,0]}}]"
            result = self.run_sinew("run", DATA / "behaviour/fast-tool.toml", "--no-output",
                                    "--set", path, code=DIVERGED)
            self.assertIn("shear waves", result.stderr)

    def test_a_given_step_that_becomes_unstable_is_refused(self):
        result = self.run_sinew("run", DATA / "truth/swing.toml", "--no-output", code=UNSTABLE)
        self.assertIn("dt", result.stderr)

    def test_heat_only_grows(self):
        for scene, settings in (("grasp", []), ("bounce", []), ("plush", ["plush.young=20000"]),
                                ("static-stack", ["stepper=\"verlet\"", "duration=0.5"]),
                                ("static-stack", ["stepper=\"implicit\"", "duration=0.5"])):
            sets = [word for setting in settings for word in ("--set", setting)]
            self.run_sinew("run", DATA / f"behaviour/{scene}.toml", "--out", "o", "--force",
                           "--set", "output.vtu=false", *sets)
            with open(self.dir / "o/energy.csv", encoding="utf-8") as file:
                heat = [float(row["dissipated [J]"]) for row in csv.DictReader(file)]
            for before, after in zip(heat, heat[1:]):
                self.assertGreaterEqual(after, before - 1e-12, scene)
        s = self.summary("behaviour/grasp.toml")
        self.assertGreater(s["friction_work"], 0.0)
        self.assertGreaterEqual(s["energy"]["dissipated"], s["friction_work"])


class Turning(CaseTest):
    def test_a_free_spin_keeps_its_energy(self):
        for young, right in (("50e3", 0.11579), ("1e6", 0.11590)):
            s = self.summary("behaviour/spin.toml", "stepper=\"implicit\"", "duration=3",
                             f"b.young={young}")
            self.near(s["energy"]["kinetic"], right, 0.005)


class Contacts(CaseTest):
    # The state is uniform: 127.78 Pa, 8 mJ. Contacts of nodes reach it to 10 %.
    def test_patch_of_two_meshes(self):
        s = self.summary("truth/cpatch.toml")
        self.near(s["energy"]["elastic"], 8.0e-3, 0.002)
        for probe in ("if_low", "if_up"):
            self.near(s["probes"][probe]["displacement"][1], -2.0e-3, 0.002)
        try:
            import meshio
        except ImportError:
            self.skipTest("meshio is not installed")
        self.run_sinew("run", DATA / "truth/cpatch.toml", "--out", "o")
        mesh = meshio.read(self.dir / "o/frames/cpatch_0001.vtu")
        for pressure in mesh.cell_data["pressure"][0]:
            self.near(float(pressure), 127.78, 0.11)

    def test_flush_boxes_in_implicit_steps(self):
        s = self.summary("behaviour/static-stack.toml", "stepper=\"implicit\"", "lower.drag=5",
                         "upper.drag=5")
        self.near(s["probes"]["upper"]["position"][1], 0.0742, 0.002)
        self.assertLess(s["static"]["newton_steps"], 3000)


    # The hard ball goes into the slab by 35 of 50 mm and comes out: the account says what led nodes
    # out of it.
    def test_a_ball_pressed_deep(self):
        s = self.summary("behaviour/press-deep.toml")
        self.assertEqual(s["status"], "finished")
        self.assertLess(s["energy"]["peak_drift"], 0.01 * s["energy"]["peak"])
        self.assertLess(s["energy"]["elastic"], 1e-6)
        self.assertTrue(any("contacts put in" in w for w in s["warnings"]), s["warnings"])


class Rest(CaseTest):
    # Uniaxial stretch by 2: half width 2.1737 mm, 2942 J, 25.88 kN; the clamped ends stiffen.
    def test_a_tendon_drawn_to_twice_its_length(self):
        s = self.summary("behaviour/tendon.toml")
        self.near(s["probes"]["mid"]["position"][0], 2.1737e-3, 0.003)
        self.near(s["energy"]["elastic"], 2942, 0.01)
        self.near(-s["pins"]["b"]["force"][2], 25.88e3, 0.01)
        self.assertLess(abs(s["probes"]["mid"]["position"][1]), 1e-6)

    def test_a_tendon_too_near_to_incompressible(self):
        result = self.run_sinew("run", DATA / "behaviour/tendon.toml", "--no-output", "--set",
                                "t.poisson=0.4999", "--set", "output.fps=4", code=DIVERGED)
        self.assertIn("take poisson = 0.499 or less", result.stderr)

    def test_a_body_on_a_body(self):
        s = self.summary("behaviour/static-stack.toml")
        self.near(s["probes"]["upper"]["position"][1], 0.0742, 0.002)

    def test_a_plate_on_foam(self):
        s = self.summary("behaviour/plush.toml", "stepper=\"static\"", "plush.young=20000")
        self.near(s["probes"]["top"]["position"][1], 0.931 * 0.08, 0.005)

    def test_a_load_above_the_limit_is_named(self):
        result = self.run_sinew("run", DATA / "behaviour/cavity.toml", "--no-output", "--set",
                                "force.p.pressure=6000", code=DIVERGED)
        self.assertIn("of the loads", result.stderr)
        s = self.summary("behaviour/cavity.toml", "force.p.pressure=6000", code=DIVERGED)
        self.assertIsNone(s["static"]["residual"])


if __name__ == "__main__":
    unittest.main()
