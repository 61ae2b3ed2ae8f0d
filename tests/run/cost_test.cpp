#include "sinew/run/cost.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "sinew/sim/internals.h"
#include "tests/support/source_dir.h"

namespace sinew {
namespace {

std::optional<std::string> warning(const std::vector<std::string>& overrides,
                                   std::string_view body = "shape = \"box\"\ncells = [1, 1, 1]") {
  const Scene scene = parse_scene(fmt::format("duration = 1\n[body.box]\n{}\n", body), "box.toml",
                                  test::source_path("."), overrides);
  Simulation simulation = sim::simulate(scene, {});
  return cost_warning(sim::internals(simulation));
}

TEST(Cost, OnlyRunsOfMoreThanADayAreAnnounced) {
  EXPECT_FALSE(warning({}));
  EXPECT_FALSE(warning({"stepper=\"static\"", "gravity=[0,0,0]"}));
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

TEST(Cost, ABadTetIsTheReasonOfAnExplicitRunOnly) {
  const char* body = "mesh = \"tests/data/meshes/repair/tiny-node.vtu\"\nscale = 0.001";
  const auto said = warning({}, body);
  ASSERT_TRUE(said);
  for (const char* part : {"of body box", "radius ratio 6.5e-08", "repair = true"})
    EXPECT_NE(said->find(part), std::string::npos) << *said;
  EXPECT_FALSE(warning({"stepper=implicit", "dt=1e-3"}, body));
  EXPECT_FALSE(warning({"box.repair=true"}, body));
  EXPECT_FALSE(warning({"duration=1e-9"}, body));
}

}  // namespace
}  // namespace sinew
