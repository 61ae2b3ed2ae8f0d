// A Simulation of a host and `sinew run` are the same steps.
#include <sinew/sinew.h>

#include <gtest/gtest.h>

#include <string>

#include "sinew/run/run.h"
#include "tests/support/effort.h"
#include "tests/support/source_dir.h"

namespace sinew {
namespace {

class SameAsRun : public testing::TestWithParam<std::string> {};

TEST_P(SameAsRun, TheSameBitsAtOneAndTwoThreads) {
  const std::string file = test::source_path("scenes/" + GetParam() + ".toml");
  // Read back from its text: what the scene is told, to the last bit.
  const std::string seconds = std::to_string(test::effort(0.2));
  const double duration = std::stod(seconds);
  const RunResult result = run_scene(load_scene(file, {"duration=" + seconds}), {});
  ASSERT_EQ(result.status, RunStatus::finished);
  for (const int threads : {1, 2}) {
    Simulation simulation = Simulation::from_file(file, {.threads = threads});
    simulation.advance(duration);
    EXPECT_EQ(simulation.hash(), result.summary.state_hash) << threads;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, SameAsRun,
                         testing::Values("press", "organs", "pull", "talk-tissue-limits"),
                         [](const auto& scene) {
                           std::string name = scene.param;
                           for (char& c : name)
                             if (c == '-') c = '_';
                           return name;
                         });

}  // namespace
}  // namespace sinew
