"""sinew info, sinew convert and sinew repair."""

import json
import unittest

from cli_support import INPUT, IO, ROOT, SCENES, USAGE, CliTest

DATA = ROOT / "tests" / "data" / "meshes"
LIVER = SCENES / "meshes" / "liver-10mm.mesh"

# Two tets on one face in region 5; node 5 is unreferenced; the first tet is inverted.
FAULTY = """MeshVersionFormatted 2
Dimension 3
Vertices
6
0 0 0 1
0.01 0 0 2
0 0.01 0 3
0 0 0.01 4
0.01 0.01 0.01 5
0.05 0.05 0.05 6
Triangles
2
1 3 2 7
1 2 6 8
Tetrahedra
2
1 2 4 3 5
5 2 4 3 5
End
"""

# A flat tet and a tet that stands twice.
HOPELESS = """MeshVersionFormatted 2
Dimension 3
Vertices
5
0 0 0 0
1 0 0 0
0 1 0 0
0 0 1 0
1 1 0 0
Tetrahedra
3
1 2 3 4 0
1 2 3 5 0
2 3 1 4 0
End
"""


def medit_sections(text):
    """The records of each section of a MEDIT file, as tuples of numbers."""
    tokens = text.split()
    sections, i = {}, 0
    width = {"Vertices": 4, "Triangles": 4, "Tetrahedra": 5}
    while i < len(tokens):
        if tokens[i] in width:
            name, count, n = tokens[i], int(tokens[i + 1]), width[tokens[i]]
            values = [float(t) for t in tokens[i + 2:i + 2 + n * count]]
            sections[name] = [tuple(values[k:k + n]) for k in range(0, n * count, n)]
            i += 2 + n * count
        else:
            i += 1
    return sections


class InfoTest(CliTest):
    def info(self, *args, code=0):
        return json.loads(self.run_sinew("info", *args, "--json", code=code).stdout)

    def test_the_liver_as_text(self):
        out = self.run_sinew("info", LIVER, "--scale", "0.001").stdout
        for part in ["1800 nodes, 7970 tets", "Regions", "edge length [m]", "dihedral angle [deg]",
                     "Dihedral angles [degrees]", "#####", "surface", "Problems",
                     "5 non-manifold edges (53-739, "]:
            self.assertIn(part, out)
        self.assertNotIn("millimetres", out)

    def test_the_liver_as_json(self):
        report = self.info(LIVER, "--scale", "0.001")
        self.assertEqual(report["nodes"], 1800)
        self.assertEqual(report["tets"], 7970)
        self.assertEqual(report["scale"], 0.001)
        self.assertEqual([r["tets"] for r in report["regions"]], [47, 812, 7111])
        self.assertAlmostEqual(sum(r["volume"] for r in report["regions"]), report["volume"])
        self.assertAlmostEqual(report["volume"], 1.7476e-3, places=6)
        self.assertGreater(report["dihedral_angle"]["min"], 12.5)
        self.assertEqual(sum(report["dihedral_angle"]["histogram"]), 6 * 7970)
        self.assertEqual(report["components"], 1)
        self.assertEqual(report["surface"]["components"], 1)
        self.assertIsNone(report["size_warning"])
        for i in range(3):
            box = report["box"]
            self.assertAlmostEqual(box["size"][i], box["max"][i] - box["min"][i])
        problem, = report["problems"]
        self.assertEqual(problem["kind"], "non_manifold_edge")
        self.assertEqual(problem["severity"], "warning")
        self.assertEqual(problem["count"], 5)
        self.assertEqual(problem["first"][0], [53, 739])

    def test_size_warnings(self):
        line = "1.7 million m3: is this mesh in millimetres? scale = 0.001"
        self.assertIn("warning     " + line, self.run_sinew("info", LIVER).stdout)
        self.assertEqual(self.info(LIVER)["size_warning"], line)
        small = self.info(LIVER, "--scale", "1e-6")["size_warning"]
        self.assertIn("leave out scale = 1e-06", small)

    def test_repairable_problems(self):
        mesh = self.write("faulty.mesh", FAULTY)
        problems = {p["kind"]: p for p in self.info(mesh)["problems"]}
        self.assertEqual(set(problems), {"inverted", "unreferenced_node", "loose_face"})
        self.assertEqual(problems["inverted"]["severity"], "repairable")
        self.assertEqual(problems["inverted"]["first"], [0])
        self.assertEqual(problems["unreferenced_node"]["first"], [5])
        self.assertAlmostEqual(self.info(mesh)["volume"], 0.5e-6)
        out = self.run_sinew("info", mesh).stdout
        self.assertIn("repairable  1 inverted tet (0): negative volume", out)
        self.assertIn("sinew convert --repair", out)

    def test_fatal_problems(self):
        mesh = self.write("hopeless.mesh", HOPELESS)
        run = self.run_sinew("info", mesh, code=INPUT)
        self.assertIn("fatal       1 duplicate tet (2): the same four nodes as an earlier tet",
                      run.stdout)
        self.assertIn("fatal       1 degenerate tet (1): no volume", run.stdout)
        self.assertIn("hopeless.mesh: the mesh cannot be simulated", run.stderr)
        kinds = [p["kind"] for p in self.info(mesh, code=INPUT)["problems"]]
        self.assertEqual(kinds, ["duplicate_tet", "degenerate"])

    def test_a_coordinate_that_is_not_finite(self):
        mesh = self.write("nan.mesh", FAULTY.replace("0 0.01 0 3", "0 nan 0 3"))
        report = self.info(mesh, code=INPUT)
        self.assertEqual(report["problems"][0]["kind"], "non_finite")
        self.assertIsNone(report["volume"])
        self.assertEqual(report["nodes"], 6)

    def test_wrong_arguments(self):
        self.assertIn("no such file", self.run_sinew("info", "none.mesh", code=INPUT).stderr)
        self.write("mesh.xyz", "hello")
        self.assertIn("unknown ending", self.run_sinew("info", "mesh.xyz", code=INPUT).stderr)
        self.run_sinew("info", code=USAGE)
        for scale in ["0", "-1", "nan", "inf", "mm"]:
            run = self.run_sinew("info", LIVER, "--scale", scale, code=USAGE)
            self.assertIn(f'"{scale}" is not a number above 0', run.stderr)

    def test_where_labels_come_from(self):
        mesh = DATA / "labels" / "tissue.vtk"
        out = self.run_sinew("info", mesh).stdout
        self.assertIn('labels    cell array "tissue"', out)
        self.assertEqual([r["label"] for r in self.info(mesh)["regions"]], [1, 2])
        mesh = DATA / "labels" / "point-fractions.vtk"
        out = self.run_sinew("info", mesh).stdout
        self.assertIn('not used  point array "material" (numbers)', out)
        self.assertEqual(self.info(mesh)["arrays"][0]["of"], "points")
        run = self.run_sinew("info", mesh, "--labels", "tissue", code=INPUT)
        self.assertIn('has no cell array "tissue"', run.stderr)

    def test_near_flat_tets_and_double_nodes_have_places(self):
        problems = {p["kind"]: p for p in self.info(DATA / "repair" / "tiny-node.vtu")["problems"]}
        self.assertIn("radius ratio 6.5e-08", problems["near_flat"]["text"])
        self.assertEqual(len(problems["near_flat"]["places"][0]), 3)
        out = self.run_sinew("info", DATA / "repair" / "double.vtu").stdout
        self.assertIn("duplicate nodes", out)
        self.assertRegex(out, r"unconnected parts \(0, \d+\): of \d+, \d+ tets")
        self.assertIn("at (", out)

    def test_surfaces_and_images_are_named(self):
        for command in (["info"], ["view", "--port", "0"], ["run"],
                        ["identify", "--young", "1e4", "--poisson", "0.3"]):
            run = self.run_sinew(*command, "x.stl", code=INPUT)
            self.assertIn("x.stl: is a surface (.stl), not a mesh of tetrahedra", run.stderr)
            self.assertIn("sinew-mesh x.stl -o x.vtu", run.stderr)
        run = self.run_sinew("run", "x.vtu", code=INPUT)
        self.assertIn("x.vtu: is a mesh, not a scene", run.stderr)

    def test_help_has_examples(self):
        for command in ["info", "convert", "repair"]:
            self.assertIn(f"  sinew {command} ", self.run_sinew(command, "--help").stdout)

    def test_a_name_that_is_not_text(self):
        path = bytes(self.dir) + b"/li\xffver.mesh"
        with open(path, "wb") as file:
            file.write(FAULTY.encode())
        self.run_sinew("info", path.decode(errors="surrogateescape"), "--json")


# Every form that convert can write: (ending, --format).
FORMS = [("mesh", None), ("node", None), ("ele", None)]
FORMS += [("msh", f) for f in (None, "gmsh41", "gmsh41-binary", "gmsh22", "gmsh22-binary")]
FORMS += [("vtk", f) for f in (None, "ascii", "binary")]
FORMS += [("vtu", f) for f in (None, "ascii", "base64", "zlib")]


class ConvertTest(CliTest):
    def test_every_format_keeps_the_liver(self):
        original = medit_sections(LIVER.read_text())
        for ending, form in FORMS:
            with self.subTest(ending=ending, form=form):
                options = ["--format", form] if form else []
                out = self.run_sinew("convert", LIVER, f"liver.{ending}", "--force", *options).stdout
                self.assertIn("1800 nodes, 7970 tets", out)
                self.run_sinew("convert", f"liver.{ending}", "back.mesh", "--force")
                back = medit_sections((self.dir / "back.mesh").read_text())
                self.assertEqual(back["Tetrahedra"], original["Tetrahedra"])
                self.assertEqual(back["Triangles"], original["Triangles"])
                if ending == "msh":
                    self.assertIn("lost       the labels of the nodes", out)
                    self.assertEqual([v[:3] for v in back["Vertices"]],
                                     [v[:3] for v in original["Vertices"]])
                else:
                    self.assertNotIn("lost", out)
                    self.assertEqual(back["Vertices"], original["Vertices"])

    def test_scale(self):
        self.run_sinew("convert", LIVER, "m.mesh", "--scale", "0.001")
        original = medit_sections(LIVER.read_text())["Vertices"]
        scaled = medit_sections((self.dir / "m.mesh").read_text())["Vertices"]
        for a, b in zip(original, scaled):
            for k in range(3):
                self.assertEqual(a[k] * 0.001, b[k])

    def test_repair(self):
        mesh = self.write("faulty.mesh", FAULTY)
        out = self.run_sinew("convert", mesh, "asis.mesh").stdout
        self.assertIn("repairable 1 inverted tet (0): negative volume; --repair puts it right", out)
        out = self.run_sinew("convert", mesh, "good.mesh", "--repair").stdout
        self.assertIn("turned     1 tets", out)
        self.assertIn("dropped    1 unreferenced nodes", out)
        self.assertIn("dropped    1 labelled faces", out)
        good = medit_sections((self.dir / "good.mesh").read_text())
        self.assertEqual(good["Tetrahedra"], [(1, 2, 3, 4, 5), (5, 2, 4, 3, 5)])
        self.assertEqual(good["Triangles"], [(1, 3, 2, 7)])
        self.assertEqual([v[3] for v in good["Vertices"]], [1, 2, 3, 4, 5])
        report = json.loads(self.run_sinew("info", "good.mesh", "--json").stdout)
        self.assertEqual(report["problems"], [])

    def test_repair_refuses_what_is_fatal(self):
        mesh = self.write("hopeless.mesh", HOPELESS)
        run = self.run_sinew("convert", mesh, "out.vtu", "--repair", code=INPUT)
        self.assertIn("hopeless.mesh: the mesh cannot be simulated: 1 duplicate tet (2): the same "
                      "four nodes as an earlier tet; 1 degenerate tet (1): no volume "
                      "(ids count from 0)", run.stderr)
        self.assertIn("remedy: ", run.stderr)
        self.assertFalse((self.dir / "out.vtu").exists())

    def test_existing_files_are_kept(self):
        mesh = self.write("faulty.mesh", FAULTY)
        self.write("out.vtu", "mine")
        run = self.run_sinew("convert", mesh, "out.vtu", code=USAGE)
        self.assertIn("out.vtu: the file exists already\n  remedy: add --force", run.stderr)
        self.assertEqual((self.dir / "out.vtu").read_text(), "mine")
        self.run_sinew("convert", mesh, "out.vtu", "--force")
        # All three files of TetGen count.
        self.write("tetgen.face", "mine")
        run = self.run_sinew("convert", mesh, "tetgen.node", code=USAGE)
        self.assertIn("tetgen.face: the file exists already", run.stderr)

    def test_wrong_arguments(self):
        mesh = self.write("faulty.mesh", FAULTY)
        for out, form, text in [("a.mesh", "binary", ".mesh files have one form only"),
                                ("a.vtu", "gmsh22", "choose one of: ascii, base64, zlib"),
                                ("a.msh", "ascii", 'no form "ascii"')]:
            run = self.run_sinew("convert", mesh, out, "--format", form, code=USAGE)
            self.assertIn(text, run.stderr)
        self.assertIn("known endings",
                      self.run_sinew("convert", mesh, "a.stl", code=INPUT).stderr)
        self.run_sinew("convert", mesh, "no/such/folder/a.vtu", code=IO)
        self.run_sinew("convert", mesh, code=USAGE)
        self.assertEqual([p.name for p in self.dir.iterdir()], ["faulty.mesh"])


class RepairTest(CliTest):
    def problems(self, mesh):
        return json.loads(self.run_sinew("info", mesh, "--json").stdout)["problems"]

    def test_double_nodes_and_flat_tets(self):
        for name, done in [("double", "double nodes joined"), ("tiny-node", "short edge")]:
            mesh = DATA / "repair" / f"{name}.vtu"
            self.assertNotEqual(self.problems(mesh), [])
            out = self.run_sinew("repair", mesh, f"{name}.vtu").stdout
            self.assertIn(done, out)
            self.assertEqual(self.problems(f"{name}.vtu"), [])

    def test_a_sound_mesh(self):
        self.run_sinew("repair", DATA / "repair" / "double.vtu", "a.vtu")
        self.assertIn("nothing to repair", self.run_sinew("repair", "a.vtu", "b.mesh").stdout)

    def test_nothing_of_the_user_is_replaced(self):
        mesh = self.write("faulty.mesh", FAULTY)
        self.write("out.vtu", "mine")
        run = self.run_sinew("repair", mesh, "out.vtu", code=USAGE)
        self.assertIn("out.vtu: the file exists already", run.stderr)
        run = self.run_sinew("repair", mesh, mesh, "--force", code=USAGE)
        self.assertIn("would replace the file that it is made from", run.stderr)

    def test_copies_of_tets_are_removed(self):
        mesh = self.write("hopeless.mesh", HOPELESS)
        out = self.run_sinew("repair", mesh, "out.mesh").stdout
        self.assertIn("1 tet removed that repeated a node or an earlier tet", out)
        self.assertIn("1 flat tet removed at the surface", out)


if __name__ == "__main__":
    unittest.main()
