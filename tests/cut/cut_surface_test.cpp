#include "sinew/cut/cut_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sinew/base/error.h"
#include "sinew/mesh/shapes.h"
#include "tests/cut/cuts.h"

namespace sinew {
namespace {

Box unit_box() {
  Box box;
  box.add(Vec3::Constant(-1.0));
  box.add(Vec3::Constant(1.0));
  return box;
}

TEST(CutSurface, FindsWhereASegmentCrosses) {
  const CutSurface s(test::disc(Vec3(0.0, 0.0, 0.25), Vec3::UnitZ(), 0.8), unit_box());
  std::vector<CutSurface::Crossing> found;
  s.cross(Vec3(0.1, 0.2, 0.0), Vec3(0.1, 0.2, 1.0), found);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].at, 0.25, 1e-6);
  EXPECT_NEAR(std::abs(s.normal(found[0].triangle).z()), 1.0, 1e-12);
  EXPECT_TRUE(s.separates(Vec3(0.0, 0.0, 0.0), Vec3(0.0, 0.0, 0.5)));
  EXPECT_FALSE(s.separates(Vec3(0.9, 0.0, 0.0), Vec3(0.9, 0.0, 0.5)));
  EXPECT_FALSE(s.separates(Vec3(0.0, 0.0, 0.3), Vec3(0.0, 0.0, 0.5)));
}

// Through a closed surface one gets from the inside to the outside by an odd number of crossings,
// also through its vertices and edges.
TEST(CutSurface, HasNoGapsBetweenItsTriangles) {
  const TetMesh ball = sphere(0.5, 4);
  const std::vector<Triangle> triangles = build_surface(ball.tets, ball.node_count()).triangles;
  const CutSurface s({ball.nodes, triangles}, unit_box());
  std::vector<Vec3> targets;
  for (const Triangle& t : triangles) {
    const Vec3 &a = ball.nodes[uz(t[0])], &b = ball.nodes[uz(t[1])], &c = ball.nodes[uz(t[2])];
    targets.insert(targets.end(), {a, b, c, 0.5 * (a + b), (a + b + c) / 3.0});
  }
  for (const Vec3& target : targets) {
    ASSERT_TRUE(s.separates(Vec3::Zero(), 2.0 * target));
    ASSERT_FALSE(s.separates(-2.0 * target, 2.0 * target));
  }
}

TEST(CutSurface, RefusesVerticesThatAreNoPlaces) {
  const CutTriangles good = test::disc(Vec3::Zero(), Vec3::UnitX(), 0.5);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e12}) {
    CutTriangles surface = good;
    surface.vertices[1].y() = bad;
    EXPECT_THROW(CutSurface(surface, unit_box()), Error) << bad;
  }
  CutTriangles surface = good;
  surface.triangles.push_back({0, 1, 13});
  EXPECT_THROW(CutSurface(surface, unit_box()), Error);
}

TEST(CutSurface, TrianglesWithoutAreaCutNothing) {
  const Vec3 p(0.1, 0.2, 0.3);
  const CutSurface s({{p, p, p, Vec3::Zero(), 2.0 * p}, {{0, 1, 2}, {0, 3, 4}}}, unit_box());
  EXPECT_TRUE(s.empty());
}

}  // namespace
}  // namespace sinew
