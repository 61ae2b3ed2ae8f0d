// Surfaces of every format, and what is said of those that are none.
#include "sinew/io/surface_file.h"

#include <gtest/gtest.h>

#include "sinew/base/error.h"
#include "sinew/io/file_io.h"
#include "tests/support/errors.h"
#include "tests/support/source_dir.h"

namespace sinew::io {
namespace {

std::string surface_seed(const std::string& name) {
  return test::source_path("fuzz/corpus/surface/" + name);
}

double volume(const SurfaceSoup& s) {
  double sum = 0;
  for (const Triangle& t : s.triangles) {
    sum += s.nodes[uz(t[0])].dot(s.nodes[uz(t[1])].cross(s.nodes[uz(t[2])])) / 6;
  }
  return sum;
}

template <typename Parse>
std::string surface_error(Parse parse, std::string_view text) {
  return test::error_of([&] { parse(text, "s"); });
}

TEST(SurfaceFile, TheSameBoxInEveryFormat) {
  for (const char* name :
       {"box.off", "box.obj", "box.stl", "box.text.stl", "box.ply", "box.bin.ply"}) {
    SCOPED_TRACE(name);
    const SurfaceSoup box = read_surface(surface_seed(name));
    EXPECT_EQ(box.nodes.size(), 8U);
    EXPECT_EQ(box.triangles.size(), 12U);
    EXPECT_DOUBLE_EQ(volume(box), 1);
  }
}

TEST(SurfaceFile, WhatIsNotGeometryIsPassedOver) {
  const SurfaceSoup colours = read_surface(surface_seed("colours.off"));
  EXPECT_EQ(colours.nodes.size(), 4U);
  EXPECT_NEAR(volume(colours), 1.0 / 6, 1e-15);
  const SurfaceSoup list = read_surface(surface_seed("list-first.ply"));
  EXPECT_EQ(list.nodes[1], Vec3(1, 0, 0));
  EXPECT_EQ(list.triangles, (std::vector<Triangle>{{0, 1, 2}}));
}

TEST(SurfaceFile, APolygonThatIsNotConvexIsSplitWithinIt) {
  const SurfaceSoup s = read_surface(surface_seed("polygon.obj"));
  EXPECT_EQ(s.polygons, 2U);
  ASSERT_EQ(s.triangles.size(), 4U);
  double area = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Triangle& t = s.triangles[i];
    const double z =
        (s.nodes[uz(t[1])] - s.nodes[uz(t[0])]).cross(s.nodes[uz(t[2])] - s.nodes[uz(t[0])]).z();
    EXPECT_GT(z, 0);  // none lies outside, turned over
    area += z / 2;
  }
  EXPECT_DOUBLE_EQ(area, 2.5);
  EXPECT_EQ(s.triangles[3], (Triangle{4, 3, 2}));  // ids from the end
}

TEST(SurfaceFile, MistakesAreNamed) {
  EXPECT_EQ(surface_error(parse_off, "PLY"),
            "s:1:1: expected OFF, found \"PLY\"\n"
            "  remedy: an OFF file starts with OFF, NOFF or COFF in a line of its own");
  EXPECT_EQ(surface_error(parse_off, "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
            "s: face 1 names vertex 3; the file has vertices 0 to 2\n"
            "  remedy: correct the id, or export the surface again");
  EXPECT_EQ(surface_error(parse_off, "OFF 3 1 0\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n"),
            "s: vertex 1 is (1, nan, 0); finite coordinates up to 1e50 were expected\n"
            "  remedy: correct it, or export the surface again");
  EXPECT_NE(surface_error(parse_off, "OFF 3000000000 1 0\n").find("cannot hold more than"),
            std::string::npos);
  EXPECT_EQ(surface_error(parse_obj, "v 0 0 0\nv 1 0 0\nf 1 2\n"),
            "s: face 1 has 2 corners; at least 3 were expected\n"
            "  remedy: export the surface as triangles");
  EXPECT_EQ(
      surface_error(parse_obj, "v 0 0 0\nf 1 a 3\n"),
      "s:2:5: expected a vertex of face 1 (an id from 1, as in 7 or 7/1/3), found \"a\"\n"
      "  remedy: a face is written: f vertex vertex vertex ...; check this entry and the count "
      "before it");
  EXPECT_EQ(surface_error(parse_obj, "hello\n"),
            "s: has no vertices: no line starts with \"v\"\n"
            "  remedy: an OBJ file has lines \"v x y z\" and \"f a b c\"; check that it is one");
  EXPECT_EQ(surface_error(parse_stl, "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n"),
            "s: ends within triangle 1\n"
            "  remedy: the file was cut short: fetch or export it again");
  std::string cut = read_file(surface_seed("box.stl"));
  cut.resize(cut.size() - 60);
  EXPECT_EQ(surface_error(parse_stl, cut),
            "s: promises 12 triangles, but its 624 bytes hold only 10\n"
            "  remedy: the file was cut short: fetch or export it again");
  EXPECT_EQ(surface_error(parse_ply,
                          "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                          "property float y\nproperty float z\nend_header\n0 0 0\n"),
            "s: has no faces: these are points or lines, not a surface\n"
            "  remedy: export the surface with its triangles");
  EXPECT_NE(
      surface_error(parse_ply, "ply\nformat binary_middle_endian 1.0\n").find("binary_big_endian"),
      std::string::npos);
}

}  // namespace
}  // namespace sinew::io
