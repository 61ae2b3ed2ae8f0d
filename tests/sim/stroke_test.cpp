#include "sinew/sim/stroke.h"

#include <gtest/gtest.h>

#include "tests/support/fields.h"
#include "tests/support/models.h"

namespace sinew::sim {
namespace {

TEST(Stroke, APlaceInTheTissueKeepsItsPlaceAtRest) {
  const Model m = test::tissue_box({}, {3, 3, 3});
  const Mat3 F = (Mat3() << 1.2, 0.1, 0.0, -0.2, 0.9, 0.1, 0.0, 0.1, 1.1).finished();
  const std::vector<Vec3> x = test::mapped(m.rest_position, F);
  const RestPlaces places(m, m.bodies[0], x);
  for (std::uint64_t n = 0; n < 50; ++n) {
    const Vec3 X = 0.09 * (random_point(n) - Vec3::Constant(0.5));
    EXPECT_LT((places.of(F * X) - X).norm(), 1e-15);
  }
  const Vec3 outside(0.09, 0.0, 0.02);  // by the motion of the tissue next to it
  EXPECT_LT((places.of(F * outside) - outside).norm(), 1e-15);
}

TEST(Stroke, SweepsAStripFromEdgeToEdge) {
  Stroke stroke;
  EXPECT_EQ(stroke.add(points_on_edge(Vec3(0, 0, 0), Vec3(0, 1, 0), 0.5)).hi.y(), 1.0);
  EXPECT_TRUE(stroke.surface.triangles.empty());
  const Box box = stroke.add(points_on_edge(Vec3(1, 0, 0), Vec3(1, 1, 0), 0.5));
  EXPECT_EQ(stroke.surface.vertices.size(), 6u);
  EXPECT_EQ(stroke.surface.triangles.size(), 4u);
  EXPECT_EQ(box.lo, Vec3(0, 0, 0));
  EXPECT_EQ(box.hi, Vec3(1, 1, 0));
}

TEST(Stroke, AnEdgeHasAFewPoints) {
  EXPECT_EQ(points_on_edge(Vec3::Zero(), Vec3(0, 1, 0), 0.1).size(), 11u);
  EXPECT_EQ(points_on_edge(Vec3::Zero(), Vec3(0, 1, 0), 5.0).size(), 2u);
  EXPECT_EQ(points_on_edge(Vec3::Zero(), Vec3(0, 1, 0), 1e-9).size(), 33u);
  EXPECT_EQ(points_on_edge(Vec3::Zero(), Vec3::Zero(), 0.1).size(), 2u);
}

}  // namespace
}  // namespace sinew::sim
