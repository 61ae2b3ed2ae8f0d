// Regions by label and by place.
#include "sinew/scene/regions.h"

#include <gtest/gtest.h>

#include "sinew/scene/place.h"
#include "tests/scene/support.h"

namespace sinew {
namespace {

// A box of two layers along y, its lower side at y = -1.
std::string layers(const std::string& regions) {
  return "[body.b]\nshape = \"box\"\nsize = [1, 2, 1]\ncells = [1, 2, 1]\n" + regions;
}

std::vector<int> regions_of(const std::string& regions) {
  const Scene s = test::parse(layers(regions));
  return regions_of_tets(place(s, s.bodies[0]));
}

std::string refusal_of(const std::string& regions) {
  return test::error_of([&] { regions_of(regions); });
}

constexpr const char* upper =
    "[body.b.region.upper]\n"
    "select = { half_space = { point = [0, 0, 0], normal = [0, 1, 0] } }\n";

TEST(Regions, TetsByTheirCentroid) {
  const Scene s = test::parse(layers(upper));
  const PlacedBody placed = place(s, s.bodies[0]);
  const std::vector<int> found = regions_of_tets(placed);
  ASSERT_EQ(found.size(), placed.mesh.tets.size());
  for (std::size_t t = 0; t < found.size(); ++t) {
    double y = 0.0;
    for (const Index corner : placed.mesh.tets[t])
      y += placed.mesh.nodes[static_cast<std::size_t>(corner)].y();
    EXPECT_EQ(found[t], y > 0.0 ? 0 : -1);
  }
}

TEST(Regions, EveryConditionHasToHold) {
  for (const int region : regions_of("[body.b.region.ball]\nselect = { sphere = { center = [0, 0, "
                                     "0], radius = 3 }, box = { min = [-1, -1, -1], max = [1, 1, "
                                     "1] } }\n"))
    EXPECT_EQ(region, 0);
}

TEST(Regions, BesideLabels) {
  EXPECT_EQ(refusal_of(std::string(upper) + "[body.b.region.all]\nlabel = 0\n")
                .find("scene.toml:6:10: tet "),
            0U);
}

TEST(Regions, ATetInTwoIsRefused) {
  const std::string text =
      refusal_of(std::string(upper) +
                 "[body.b.region.all]\nselect = { sphere = { center = [0, 0, 0], radius "
                 "= 9 } }\n");
  EXPECT_NE(text.find("is in region 'upper' and in region 'all'"), std::string::npos) << text;
  EXPECT_NE(text.find("remedy: a tet belongs to one region"), std::string::npos) << text;
}

TEST(Regions, APlaceWithoutTetsIsRefused) {
  const std::string text = refusal_of(
      "[body.b.region.a]\nselect = { sphere = { center = [0, 0, 0], radius = 1e-3 } }\n");
  EXPECT_NE(text.find("'select' of [body.b.region.a] holds no tet's centroid; the body reaches "
                      "from (-0.5, -1, -0.5) to (0.5, 1, 0.5) m"),
            std::string::npos)
      << text;
}

TEST(Regions, ConditionsOnNodesAreRefused) {
  const std::string text = refusal_of("[body.b.region.a]\nselect = { side = \"+y\" }\n");
  EXPECT_NE(text.find("'side' in 'select' of [body.b.region.a] selects nodes"), std::string::npos)
      << text;
}

}  // namespace
}  // namespace sinew
