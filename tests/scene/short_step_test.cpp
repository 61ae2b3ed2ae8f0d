// The bad tet that makes explicit steps very short.
#include "sinew/scene/short_step.h"

#include <gtest/gtest.h>

#include "sinew/scene/place.h"
#include "tests/scene/support.h"

namespace sinew {
namespace {

constexpr const char* tiny_node_scene = R"(
duration = 0.2
[body.b]
mesh = "../tests/data/meshes/repair/tiny-node.vtu"
scale = 0.001
)";

std::optional<ShortStep> found_with(const std::vector<std::string>& overrides = {}) {
  const Scene s = test::parse(tiny_node_scene, overrides);
  return place(s, s.bodies[0]).short_step;
}

TEST(ShortStep, NamesTheTetAndTheRemedy) {
  const auto found = found_with();
  ASSERT_TRUE(found.has_value());
  for (const char* part :
       {"tet ", "of body b", "radius ratio 6.5e-08", "repair = true", "\"implicit\""})
    EXPECT_NE(found->reason.find(part), std::string::npos) << found->reason;
}

TEST(ShortStep, NothingInARepairedMesh) {
  EXPECT_FALSE(found_with({"b.repair=true"}).has_value());
}

TEST(BodyWarnings, TheUnitOfTheMeshIsTheFirstWarning) {
  const Scene s = test::parse(R"(
[body.b]
mesh = "../tests/data/meshes/repair/millimetres.vtu"
)");
  const PlacedBody placed = place(s, s.bodies[0]);
  ASSERT_FALSE(placed.warnings.empty());
  EXPECT_NE(placed.warnings[0].find("is this mesh in millimetres?"), std::string::npos);
}

}  // namespace
}  // namespace sinew
