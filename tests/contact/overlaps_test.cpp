#include "sinew/contact/overlaps.h"

#include <gtest/gtest.h>

#include "tests/contact/contact_models.h"

namespace sinew {
namespace {

TEST(Overlaps, CubesThatOverlapAreKnownWithTheirDepth) {
  const TetMesh cube = box(Vec3(0.1, 0.1, 0.1), {4, 4, 4});
  const Model model = testing::surface_pair_model(
      {cube, testing::moved(cube, Vec3(0.01, 0.09, 0.013)), testing::moved(cube, Vec3(1, 0, 0))});
  const std::vector<Overlap> found = find_overlaps(model, model.rest_position);
  ASSERT_EQ(found.size(), 2u);
  for (const Overlap& o : found) {
    EXPECT_EQ(o.nodes, 16);
    EXPECT_NEAR(o.depth, 0.01, 1e-12);
  }
  EXPECT_EQ(found[0].a, 0);
  EXPECT_EQ(found[0].b, 1);
  EXPECT_EQ(found[1].a, 1);
  EXPECT_TRUE(find_overlaps(model, model.rest_position, 0.011).empty());
}

TEST(Overlaps, BodiesThatTouchDoNotOverlap) {
  const TetMesh ball = sphere(0.05, 3);
  const Model model = testing::surface_pair_model({ball, testing::moved(ball, Vec3(0, 0.11, 0))});
  EXPECT_TRUE(find_overlaps(model, model.rest_position).empty());
}

}  // namespace
}  // namespace sinew
