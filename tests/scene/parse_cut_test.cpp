#include <gtest/gtest.h>

#include "sinew/scene/rigid_mesh.h"
#include "tests/scene/support.h"
#include "tests/support/folder.h"

namespace sinew {
namespace {

using test::parse;
using test::parse_error;

const std::string beam = "[body.beam]\nshape = \"beam\"\n";

TEST(ParseCut, ReadsEverySurface) {
  const Scene s = parse(beam + R"(
[cut.a]
time = 0.5
plane = { point = [1, 2, 3], normal = [0, 0, 2] }
[cut.b]
at_rest = true
disc = { center = [1, 0, 0], normal = [0, 1, 0], radius = 0.2 }
[cut.c]
blade = [{ heel = [0, 0, 0], tip = [0, 1, 0] }, { time = 1, heel = [1, 0, 0], tip = [1, 1, 0] }]
[cut.d]
mesh = "a.stl"
scale = 0.001
body = "beam"
)");
  ASSERT_EQ(s.cuts.size(), 4u);
  EXPECT_EQ(s.cuts[0].name, "a");
  EXPECT_EQ(s.cuts[0].time, 0.5);
  EXPECT_EQ(s.cuts[0].plane->point, Vec3(1, 2, 3));
  EXPECT_EQ(s.cuts[0].plane->normal, Vec3(0, 0, 1));
  EXPECT_EQ(s.cuts[0].body, "");
  EXPECT_FALSE(s.cuts[0].at_rest);
  EXPECT_TRUE(s.cuts[1].at_rest);
  EXPECT_EQ(s.cuts[1].disc->radius, 0.2);
  ASSERT_EQ(s.cuts[2].blade.size(), 2u);
  EXPECT_EQ(s.cuts[2].blade[1].tip, Vec3(1, 1, 0));
  EXPECT_EQ(s.cuts[2].blade[1].time, 1.0);
  EXPECT_EQ(s.cuts[2].body, "beam");  // the only one
  EXPECT_EQ(s.cuts[3].mesh, "a.stl");
  EXPECT_EQ(s.cuts[3].scale, 0.001);
}

TEST(ParseCut, NamesItsMistakes) {
  const auto error = [](const std::string& cut) { return parse_error(beam + "[cut.a]\n" + cut); };
  EXPECT_EQ(error("time = 1\n"),
            "scene.toml:3:1: [cut.a] has none of 'plane', 'disc', 'blade' and 'mesh'\n"
            "  remedy: a cut all through is plane = { point = [0, 0, 0], normal = [1, 0, 0] }; a "
            "table has one of the four");
  EXPECT_NE(error("mesh = \"a.stl\"\nplane = { point = [0, 0, 0], normal = [1, 0, 0] }\n")
                .find("has more than one of"),
            std::string::npos);
  EXPECT_NE(error("blade = [{ heel = [0, 0, 0], tip = [0, 1, 0] }]\n").find("has 1 edge"),
            std::string::npos);
  EXPECT_NE(error("blade = [{ time = 1, heel = [0, 0, 0], tip = [0, 1, 0] }, "
                  "{ heel = [1, 0, 0], tip = [1, 1, 0] }]\n")
                .find("edge 2 of the blade is at 0 s, before the one before it at 1 s"),
            std::string::npos);
  EXPECT_NE(error("time = 1\nblade = [{ heel = [0, 0, 0], tip = [0, 1, 0] }, "
                  "{ heel = [1, 0, 0], tip = [1, 1, 0] }]\n")
                .find("does not go with a blade"),
            std::string::npos);
  EXPECT_NE(error("blade = [{ heel = [0, 0, 0] }]\n").find("has no 'tip'"), std::string::npos);
  EXPECT_NE(error("disc = { center = [0, 0, 0], normal = [0, 1, 0] }\n").find("has no 'radius'"),
            std::string::npos);
  EXPECT_NE(error("plane = { point = [0, 0, 0], normal = [0, 0, 0] }\n").find("normal"),
            std::string::npos);
  EXPECT_NE(error("scale = 2\nplane = { point = [0, 0, 0], normal = [1, 0, 0] }\n")
                .find("goes with a mesh"),
            std::string::npos);
  EXPECT_NE(
      error("body = \"bean\"\nplane = { point = [0, 0, 0], normal = [1, 0, 0] }\n").find("bean"),
      std::string::npos);
  EXPECT_NE(error("time = -1\nplane = { point = [0, 0, 0], normal = [1, 0, 0] }\n").find("time"),
            std::string::npos);
}

TEST(ParseCut, ReadsTheSurfaceOfAMesh) {
  const test::Folder folder;
  const std::string file =
      folder.write("sinew-blade.off", "OFF\n3 1 0\n0 0 0\n10 0 0\n0 0 10\n3 0 1 2\n");
  const Scene s = parse(beam + "[cut.a]\nscale = 0.1\nmesh = \"" + file + "\"\n");
  const CutTriangles surface = read_cut_mesh(s, s.cuts[0]);
  ASSERT_EQ(surface.vertices.size(), 3u);
  EXPECT_EQ(surface.vertices[1], Vec3(1, 0, 0));
  EXPECT_EQ(surface.triangles.size(), 1u);
  const Scene none = parse(beam + "[cut.a]\nmesh = \"/nowhere/a.stl\"\n");
  EXPECT_EQ(test::error_of([&] { read_cut_mesh(none, none.cuts[0]); }),
            "scene.toml:4:8: the mesh of [cut.a] is not there: /nowhere/a.stl\n"
            "  remedy: mesh paths start from the scene file's folder");
}

}  // namespace
}  // namespace sinew
