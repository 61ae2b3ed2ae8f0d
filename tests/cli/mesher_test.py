"""sinew-mesh: fills surfaces and images with tets, or reports their faults.

Skipped if sinew-mesh is not built: it needs CGAL (./dev setup mesher), and CI does not build it.
"""

import gzip
import json
import math
import os
import pathlib
import re
import signal
import struct
import subprocess
import time
import unittest

import mesher_surfaces as surfaces
import numpy as np
from cli_support import BIN, INPUT, IO, ROOT, SCENES, USAGE, CliTest
from mesh_commands_test import medit_sections
from mesher_surfaces import ball, box, join, moved, without

MESHER = os.environ.get("SINEW_MESH_BIN") or str(pathlib.Path(BIN).parent / "sinew-mesh")
BALL = 4 * math.pi / 3


def liver_image(spacing=2.0):
    """The liver of scenes/meshes as voxels: labels (i, j, k), the corner, in millimetres."""
    sections = medit_sections((SCENES / "meshes" / "liver-6mm.mesh").read_text())
    nodes = np.array([v[:3] for v in sections["Vertices"]])
    tets = np.array(sections["Tetrahedra"], dtype=int)
    low = nodes.min(axis=0) - 3 * spacing
    size = np.ceil((nodes.max(axis=0) + 3 * spacing - low) / spacing).astype(int) + 1
    voxels = np.zeros(size, dtype=np.uint8)
    for a, b, c, d, label in tets:
        x = nodes[[a - 1, b - 1, c - 1, d - 1]]
        first = np.ceil((x.min(axis=0) - low) / spacing).astype(int)
        last = np.floor((x.max(axis=0) - low) / spacing).astype(int)
        if (last < first).any():
            continue
        cells = np.stack(np.meshgrid(*[np.arange(f, t + 1) for f, t in zip(first, last)],
                                     indexing="ij"), axis=-1).reshape(-1, 3)
        inside = np.linalg.solve((x[1:] - x[0]).T, (low + spacing * cells - x[0]).T)
        hit = cells[((inside >= 0).all(axis=0)) & (inside.sum(axis=0) <= 1)]
        voxels[hit[:, 0], hit[:, 1], hit[:, 2]] = label
    return voxels, low


def write_inr(path, voxels, spacing=1.0, corner=(0.0, 0.0, 0.0)):
    head = "#INRIMAGE-4#{\nXDIM=%d\nYDIM=%d\nZDIM=%d\nVDIM=1\n" % voxels.shape
    head += "TYPE=unsigned fixed\nPIXSIZE=8 bits\nCPU=decm\n"
    head += "VX=%g\nVY=%g\nVZ=%g\n" % ((spacing,) * 3)
    head += "TX=%.17g\nTY=%.17g\nTZ=%.17g\n" % tuple(corner)
    head += "\n" * (256 - len(head) - 4) + "##}\n"
    data = head.encode() + voxels.tobytes(order="F")
    path.write_bytes(gzip.compress(data) if path.suffix == ".gz" else data)
    return path


def write_nifti(path, voxels, matrix):
    head = bytearray(352)
    struct.pack_into("<i", head, 0, 348)
    struct.pack_into("<8h", head, 40, 3, *voxels.shape, 1, 1, 1, 1)
    struct.pack_into("<h", head, 70, 2)
    struct.pack_into("<8f", head, 76, 1, 1, 1, 1, 0, 0, 0, 0)
    struct.pack_into("<f", head, 108, 352)
    struct.pack_into("<h", head, 254, 1)
    struct.pack_into("<12f", head, 280, *np.asarray(matrix)[:3].ravel())
    head[344:348] = b"n+1\0"
    data = bytes(head) + voxels.tobytes(order="F")
    path.write_bytes(gzip.compress(data) if path.suffix == ".gz" else data)
    return path


@unittest.skipUnless(os.access(MESHER, os.X_OK),
                     f"sinew-mesh is not built ({MESHER}): it needs CGAL, ./dev setup mesher")
class MesherTest(CliTest):
    def mesh(self, *args, code=0, timeout=120):
        result = subprocess.run([MESHER, *map(str, args)], cwd=self.dir, text=True,
                                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, timeout=timeout)
        if code is not None and result.returncode != code:
            self.fail(f"sinew-mesh {' '.join(map(str, args))}: exit code {result.returncode}, "
                      f"expected {code}\n{result.stdout}\n{result.stderr}")
        return result

    def report(self, *args, **options):
        return json.loads(self.mesh(*args, "--json", **options).stdout)

    def info(self, mesh):
        return json.loads(self.run_sinew("info", mesh, "--json", code=None).stdout)

    def surface(self, name, surface):
        return surfaces.write(self.dir / name, surface)

    # --- surfaces that can be filled ------------------------------------------------------------

    def fill(self, name, surface, size, volume, *options, within=0.02, parts=1, angle=10):
        """Meshes a surface; its volume, parts and smallest angle are as expected, and sinew takes
        the mesh."""
        self.surface(name, surface)
        r = self.report(name, "--size", repr(size), "-o", "out.mesh", "--force", *options)
        self.assertTrue(r["usable"])
        self.assertEqual(r["volumes"][0]["label"], 1)
        self.assertLess(abs(r["volumes"][0]["mesh"] / volume - 1), within, r["volumes"])
        self.assertGreater(r["dihedral_angle"]["min"], angle)
        told = self.info("out.mesh")
        self.assertEqual(told["tets"], r["tets"])
        self.assertEqual(told["components"], parts)
        self.assertFalse([p for p in told["problems"] if p["severity"] != "warning"], told["problems"])
        return r

    def test_01_ball(self):
        r = self.fill("s.off", ball(level=4), 0.15, BALL)
        self.assertAlmostEqual(r["edge_length"]["mean"], 0.15, delta=0.02)
        self.assertEqual(r["findings"], [])

    def test_02_cube_with_sharp_edges(self):
        r = self.fill("s.obj", box(), 0.15, 1, "--sharp", 60, within=1e-9)
        faces = medit_sections((self.dir / "out.mesh").read_text())["Triangles"]
        self.assertEqual({f[3] for f in faces}, {1, 2, 3, 4, 5, 6})  # one label a side
        self.assertEqual(r["extent"], [1, 1, 1])

    def test_03_torus(self):
        self.fill("s.ply", surfaces.torus(), 0.1, 2 * math.pi ** 2 * 0.35 ** 2, within=0.04)

    def test_04_two_balls(self):
        r = self.fill("s.bin.ply", join(ball(), ball(0.5, (2.5, 0, 0))), 0.15, 1.125 * BALL, parts=2,
                      within=0.03)
        self.assertEqual([p["depth"] for p in r["parts"]], [0, 0])

    def test_05_cavity(self):
        r = self.fill("s.stl", join(ball(), ball(0.5)), 0.15, 0.875 * BALL)
        self.assertEqual([p["depth"] for p in r["parts"]], [0, 1])
        self.assertIn("2 closed parts: 1 filled, 1 inside another and left hollow",
                      r["findings"][0]["text"])

    def test_06_many_small_balls(self):
        many = join(*[ball(0.2, (i, j, k), 3) for i in range(3) for j in range(3) for k in range(3)])
        self.fill("s.off", many, 0.1, 27 * 0.2 ** 3 * BALL, within=0.12, parts=27)

    def test_07_tiny(self):
        r = self.fill("s.ply", moved(ball(), 1e-9), 1.5e-10, 1e-27 * BALL)
        self.assertIn("scaled twice", " ".join(r["warnings"]))

    def test_08_huge(self):
        self.fill("s.off", moved(ball(), 1e9), 1.5e8, 1e27 * BALL)

    def test_09_far_from_the_origin(self):
        self.fill("s.ply", moved(ball(), 1, (1e6, -1e6, 0)), 0.15, BALL)

    def test_10_thin_plate(self):
        r = self.fill("s.obj", box((1, 1, 0.03)), 0.15, 0.03, "--sharp", 60, angle=5)
        self.assertLess(r["edge_length"]["mean"], 0.1)  # finer than asked for, where it is thin

    def test_11_spike(self):
        r = self.fill("s.off", surfaces.spike(), 0.1, math.pi * 0.25 ** 2 * 4 / 3, within=0.06)
        self.assertGreater(r["tets"], 100)

    def test_12_turned_at_random(self):
        r = self.fill("s.text.stl", surfaces.reversed_at_random(ball()), 0.15, BALL)
        self.assertIn("turned", [f["kind"] for f in r["findings"]])

    def test_13_doubled_triangles(self):
        nodes, faces = ball()
        r = self.fill("s.ply", (nodes, faces + faces[:300]), 0.15, BALL)
        self.assertIn("300 triangles at the place of an earlier one", r["findings"][0]["text"])

    def test_14_boxes_that_share_a_side(self):
        r = self.fill("s.off", join(box(), box(origin=(0, 0, 1))), 0.15, 2, "--sharp", 60, within=1e-9)
        self.assertIn("2 that were a wall inside", r["findings"][0]["text"])

    def test_15_boxes_that_touch(self):
        for name, origin in [("edge", (1, 1, 0)), ("corner", (1, 1, 1))]:
            with self.subTest(name):
                r = self.fill("s.off", join(box(), box(origin=origin)), 0.15, 2)
                self.assertIn("touching", [f["kind"] for f in r["findings"]])

    def test_16_corners_of_their_own(self):
        self.fill("s.off", surfaces.split_corners(ball()), 0.15, BALL)

    # --- surfaces that cannot, and what --repair makes of them ----------------------------------

    def refuse(self, name, surface, kind, text):
        """The surface is refused with this finding; nothing is written."""
        self.surface(name, surface)
        run = self.mesh(name, "--size", "0.15", "-o", "bad.mesh", code=INPUT)
        self.assertRegex(run.stderr, text)
        self.assertIn("remedy: ", run.stderr)
        self.assertFalse((self.dir / "bad.mesh").exists())
        r = self.report(name, code=INPUT)
        self.assertFalse(r["usable"])
        self.assertIn(kind, [f["kind"] for f in r["findings"]])
        return r

    def repaired(self, name, surface, volume, did, **options):
        r = self.fill(name, surface, 0.15, volume, "--repair", **options)
        self.assertRegex(" ".join(r["repairs"]), did)

    def test_17_open(self):
        bowl = without(ball(), lambda p: min(q[2] for q in p) > 0.7)
        self.refuse("s.off", bowl, "open", r"open: 1 hole \(30 edges in all\); it has its 30 edges "
                                           r"around \(0, 0, 0.7428\), 4.565 round")
        self.repaired("s.off", bowl, 0.95 * BALL, "filled 1 hole", within=0.03)

    def test_18_no_lid(self):
        nodes, faces = box()
        self.refuse("s.obj", (nodes, faces[:-1]), "open", "open: 1 hole .* around \\(0.5, 0.5, 1\\)")
        self.repaired("s.obj", (nodes, faces[:-1]), 1, "filled 1 hole")

    def test_19_crossing_parts(self):
        pair = join(ball(), ball(centre=(1, 0.1, 0.05)))
        self.refuse("s.off", pair, "crossing", r"crosses itself: 158 crossing pairs of triangles "
                                               r"\(between parts\), one at")
        d = math.hypot(1, 0.1, 0.05)
        lens = math.pi * (4 + d) * (2 - d) ** 2 / 12
        self.repaired("s.off", pair, 2 * BALL - lens, "united 2 parts", within=0.03)

    def test_20_a_part_that_crosses_itself(self):
        self.refuse("s.off", surfaces.dented_ball(), "crossing", "within one part")
        self.repaired("s.off", surfaces.dented_ball(), 3.65, "cut out where", within=0.05)

    def test_21_wall_inside(self):
        walled = surfaces.ball_with_wall()
        self.refuse("s.off", walled, "wall", "32 edges with an odd number of triangles")
        self.repaired("s.off", walled, BALL, "left out 32 triangles of a wall", within=0.04)

    def test_22_gaps(self):
        gaps = surfaces.split_corners(ball(), 1e-8)
        self.refuse("s.off", gaps, "open", "open: 1280 holes")
        self.repaired("s.off", gaps, BALL, "joined 3198 nodes")

    def test_23_one_sided(self):
        for name, surface in [("moebius", surfaces.moebius()), ("klein", surfaces.klein())]:
            with self.subTest(name):
                self.refuse("s.off", surface, "not_orientable", "has one side only")
                self.report("s.off", "--repair", code=INPUT)

    def test_24_flat(self):
        sheet = ([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2, 3), (3, 2, 1, 0)])
        self.refuse("s.off", sheet, "no_volume", "encloses no volume")

    def test_25_triangles_at_random(self):
        self.refuse("s.off", surfaces.random_triangles(), "open", "open: 60 holes")
        self.mesh("s.off", "--repair", code=INPUT)

    def test_26_files_that_are_no_surface(self):
        self.write("empty.stl", "")
        self.write("hello.off", "hello")
        self.surface("points.ply", (ball(level=0)[0], []))
        self.write("nan.off", "OFF 3 1 0\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n")
        self.write("s.xyz", "1 2 3")
        for name, text in [("empty.stl", "is empty"), ("hello.off", "expected OFF"),
                           ("points.ply", "has no faces"), ("nan.off", "vertex 1 is"),
                           ("s.xyz", "unknown ending"), ("none.stl", "no such file")]:
            run = self.mesh(name, code=INPUT)
            self.assertIn(text, run.stderr)
            self.assertIn(name, run.stderr)
            self.assertIn("remedy: ", run.stderr)

    # --- images ---------------------------------------------------------------------------------

    def test_the_liver_as_an_image(self):
        voxels, corner = liver_image()
        write_inr(self.dir / "liver.inr.gz", voxels, 2.0, corner)
        start = time.monotonic()
        r = self.report("liver.inr.gz", "--scale", "0.001", "--size", "6mm", "-o", "liver.vtu")
        self.assertLess(time.monotonic() - start, 30)  # 3 to 4 s where nothing else runs
        self.assertGreater(r["dihedral_angle"]["min"], 10)
        self.assertAlmostEqual(r["edge_length"]["mean"], 0.006, delta=0.0006)
        self.assertEqual([v["label"] for v in r["volumes"]], [1, 2, 3])
        for v in r["volumes"][1:]:
            self.assertLess(abs(v["mesh"] / v["input"] - 1), 0.02)
        told = self.info("liver.vtu")
        self.assertEqual(told["components"], 1)
        original = json.loads(self.run_sinew("info", SCENES / "meshes" / "liver-6mm.mesh", "--scale",
                                             "0.001", "--json").stdout)
        self.assertLess(abs(told["volume"] / original["volume"] - 1), 0.02)
        for i in range(3):
            self.assertAlmostEqual(told["box"]["min"][i], original["box"]["min"][i], delta=0.003)

    def two_halves(self):
        i = np.indices((30, 24, 20)) - np.array([14.5, 11.5, 9.5]).reshape(3, 1, 1, 1)
        inside = (i ** 2).sum(axis=0) < 8 ** 2
        return np.where(inside, np.where(i[0] < 0, 7, 9), 0).astype(np.uint8)

    def test_labels_stay_and_a_mirrored_frame_does_too(self):
        matrix = [[0, 0, -2, 5], [-2, 0, 0, 6], [0, 2, 0, 7]]  # left-handed, and turned
        for sign in [1, -1]:
            matrix[2][1] = 2 * sign
            write_nifti(self.dir / "s.nii.gz", self.two_halves(), matrix)
            r = self.report("s.nii.gz", "--size", 3, "-o", "s.mesh", "--force")
            self.assertEqual([v["label"] for v in r["volumes"]], [7, 9])
            told = self.info("s.mesh")
            self.assertFalse([p for p in told["problems"] if p["kind"].startswith("inverted")])
            sections = medit_sections((self.dir / "s.mesh").read_text())
            nodes = np.array([v[:3] for v in sections["Vertices"]])
            middle = np.array(matrix) @ [14.5, 11.5, 9.5, 1]
            self.assertLess(np.abs((nodes.max(axis=0) + nodes.min(axis=0)) / 2 - middle).max(), 1)
            for tet in sections["Tetrahedra"]:  # i < 0 is y > 6
                y = nodes[[int(n) - 1 for n in tet[:4]], 1].mean()
                if abs(y - middle[1]) > 1.5:
                    self.assertEqual(tet[4], 7 if y > middle[1] else 9)
            self.assertEqual({f[3] for f in sections["Triangles"]}, {7, 9})

    def test_images_that_are_none(self):
        write_inr(self.dir / "empty.inr", np.zeros((4, 4, 4), dtype=np.uint8))
        self.assertIn("no voxel with a label", self.mesh("empty.inr", code=INPUT).stderr)
        speck = np.zeros((20, 20, 20), dtype=np.uint8)
        speck[10, 10, 10] = 1
        write_inr(self.dir / "speck.inr", speck)
        run = self.mesh("speck.inr", "--size", 5, "-o", "s.mesh", code=INPUT)
        self.assertIn("no part as large as one tetrahedron", run.stderr)
        self.mesh("speck.inr", "--sharp", 60, "-o", "s.mesh", code=USAGE)

    # --- scenes ---------------------------------------------------------------------------------

    SCENE = """duration = 0.001
[body.b]
mesh = "s.off"
mesh_size = %s
scale = 0.001
"""

    def run_scene(self, code=0, size="0.015", mesher=MESHER):
        self.write("s.toml", self.SCENE % size)
        env = {**os.environ, "XDG_CACHE_HOME": str(self.dir / "cache"), "SINEW_MESH": mesher}
        return self.run_sinew("run", "s.toml", "--no-output", "--json", code=code, env=env)

    def test_a_scene_names_a_surface(self):
        self.surface("s.off", moved(ball(), 50))
        first = json.loads(self.run_scene().stdout)
        self.assertGreater(first["bodies"][0]["tets"], 500)
        kept = list((self.dir / "cache" / "sinew" / "meshes").iterdir())
        self.assertEqual(len(kept), 1)
        # The second time the mesher is not asked.
        again = json.loads(self.run_scene(mesher="/nowhere/sinew-mesh").stdout)
        self.assertEqual(again["state_hash"], first["state_hash"])
        # Another size, another mesh.
        finer = json.loads(self.run_scene(size="0.012").stdout)
        self.assertGreater(finer["bodies"][0]["tets"], first["bodies"][0]["tets"])

    def test_a_scene_says_why_it_cannot_be_filled(self):
        self.surface("s.off", without(ball(50), lambda p: min(q[2] for q in p) > 35))
        run = self.run_scene(code=INPUT)
        self.assertIn("s.toml:3:", run.stderr)
        self.assertIn("s.off: cannot be filled: open: 1 hole", run.stderr)
        run = self.run_scene(code=INPUT, mesher="/nowhere/sinew-mesh")
        self.assertIn("cannot be started: No such file", run.stderr)
        self.assertIn("remedy: ./dev mesh builds it", run.stderr)
        self.assertEqual(list((self.dir / "cache" / "sinew" / "meshes").iterdir()), [])
        self.write("m.toml", '[body.b]\nshape = "beam"\nmesh_size = 0.1\n')
        run = self.run_sinew("run", "m.toml", code=INPUT)
        self.assertIn("'mesh_size' in [body.b] goes with a surface or an image only", run.stderr)

    # --- the command ----------------------------------------------------------------------------

    def test_the_same_mesh_every_time(self):
        self.surface("s.off", ball())
        for name in ["a.mesh", "b.mesh"]:
            self.mesh("s.off", "--size", 0.2, "-o", name)
        self.assertEqual((self.dir / "a.mesh").read_bytes(), (self.dir / "b.mesh").read_bytes())

    def test_units(self):
        self.surface("s.off", moved(ball(), 50))
        tets = set()
        for size in ["10", "10mm", "1cm", "0.01m", "10000um"]:
            r = self.report("s.off", "--scale", "0.001", "--size", size, "-o", "s.vtu", "--force")
            tets.add(r["tets"])
            self.assertAlmostEqual(r["size"], 0.01)
            self.assertAlmostEqual(r["volumes"][0]["input"], 0.05 ** 3 * BALL, delta=6e-6)
        self.assertEqual(len(tets), 1)

    def test_wrong_usage(self):
        self.surface("s.off", ball())
        self.write("mine.mesh", "mine")
        for args, text in [(["--size", "0"], "is not a length above 0"),
                           (["--size", "6 furlongs"], "is not a length above 0"),
                           (["--size", "5"], "longer than the whole input"),
                           (["--size", "1e-4"], "million tets"),
                           (["-o", "mine.mesh"], "exists already"),
                           (["-o", "s.xyz"], "unknown ending"), (["--scale", "-1"], "--scale"),
                           (["--sharp", "200"], "--sharp")]:
            args = args if "-o" in args else [*args, "-o", "s.mesh"]
            run = self.mesh("s.off", *args, code=USAGE)
            self.assertIn(text, run.stderr)
        self.mesh("s.off", "-o", "none/s.mesh", code=IO)
        self.assertEqual((self.dir / "mine.mesh").read_text(), "mine")
        self.assertFalse((self.dir / "s.mesh").exists())

    def test_help(self):
        out = self.mesh("--help").stdout
        self.assertIn("  sinew-mesh organ.stl --scale 0.001 --size 6mm -o organ.vtu", out)
        self.assertRegex(self.mesh("--version").stdout, r"sinew-mesh \d")

    def test_completions_know_every_option(self):
        options = set(re.findall(r"^  (?:-\w,)?--([\w-]+)", self.mesh("--help").stdout, re.MULTILINE))
        self.assertIn("size", options)
        for shell in ["bash", "zsh", "fish"]:
            text = (ROOT / "completions" / f"sinew.{shell}").read_text(encoding="utf-8")
            text = text[text.index("sinew-mesh", 40):] if shell != "bash" else text
            for option in options:
                self.assertRegex(text, (r"-l " if shell == "fish" else "--") + rf"{option}\b")

    def test_an_interrupt_leaves_nothing(self):
        self.surface("s.off", ball())
        process = subprocess.Popen([MESHER, "s.off", "--size", "0.03", "-o", "s.mesh"], cwd=self.dir,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        time.sleep(0.5)
        process.send_signal(signal.SIGINT)
        _, told = process.communicate(timeout=30)
        self.assertEqual(process.returncode, 130)
        self.assertIn("interrupted, nothing was written", told)
        self.assertEqual([p.name for p in self.dir.iterdir()], ["s.off"])


if __name__ == "__main__":
    unittest.main()
