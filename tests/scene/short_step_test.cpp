// The warning of explicit steps that one bad tet makes very short.
#include "sinew/scene/step_cost.h"

#include <gtest/gtest.h>

#include "tests/scene/support.h"

namespace sinew {
namespace {

constexpr const char* tiny_node_scene = R"(
duration = 0.2
[body.b]
mesh = "../tests/data/meshes/repair/tiny-node.vtu"
scale = 0.001
)";

std::optional<std::string> warning_with(const std::vector<std::string>& overrides = {}) {
  const Scene s = test::parse(tiny_node_scene, overrides);
  return step_warning(s, place(s, s.bodies[0]));
}

TEST(StepCost, NamesTheTetTheStepsAndTheRemedy) {
  const auto text = warning_with();
  ASSERT_TRUE(text.has_value());
  for (const char* part :
       {"tet ", "radius ratio 6.5e-08", "repair = true", "\"implicit\"", "for 0.2 s"})
    EXPECT_NE(text->find(part), std::string::npos) << *text;
}

TEST(StepCost, NothingForOtherSteppersAndRepairedMeshes) {
  EXPECT_FALSE(warning_with({"stepper=implicit"}).has_value());
  EXPECT_FALSE(warning_with({"b.repair=true"}).has_value());
  EXPECT_FALSE(warning_with({"duration=1e-9"}).has_value());
}

TEST(StepCost, TheUnitOfTheMeshIsTheFirstWarning) {
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
