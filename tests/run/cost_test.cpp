#include "sinew/run/cost.h"

#include <gtest/gtest.h>

#include "sinew/sim/internals.h"

namespace sinew {
namespace {

std::optional<std::string> warning(const std::vector<std::string>& overrides) {
  const Scene scene = parse_scene("duration = 1\n[body.box]\nshape = \"box\"\ncells = [1, 1, 1]\n",
                                  "box.toml", {}, overrides);
  Simulation simulation = sim::simulate(scene, {});
  return cost_warning(sim::internals(simulation));
}

TEST(Cost, OnlyRunsOfMoreThanADayAreAnnounced) {
  EXPECT_FALSE(warning({}));
  EXPECT_FALSE(warning({"stepper=\"static\""}));
  const auto said = warning({"dt=1e-13"});
  ASSERT_TRUE(said);
  EXPECT_NE(said->find("1e+13 steps of 1e-13 s"), std::string::npos) << *said;
  EXPECT_NE(said->find("the scene gives this step"), std::string::npos) << *said;
}

TEST(Cost, AStiffBodyIsTheReason) {
  const auto said = warning({"box.young=1e26"});
  ASSERT_TRUE(said);
  EXPECT_NE(said->find("stiffest spring"), std::string::npos) << *said;
}

}  // namespace
}  // namespace sinew
