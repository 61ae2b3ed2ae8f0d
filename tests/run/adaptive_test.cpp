// What a run of Verlet's steps does when the body stiffens, softens or turns over: it follows, and
// counts.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "sinew/run/run.h"

namespace sinew {
namespace {

Summary finished(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const Scene scene =
      parse_scene(text, "adaptive.toml", std::filesystem::temp_directory_path(), overrides);
  const RunResult result = run_scene(scene, {});
  EXPECT_EQ(result.status, RunStatus::finished) << (result.error ? result.error->what() : "");
  EXPECT_TRUE(std::isfinite(result.summary.energy.kinetic));
  return result.summary;
}

// A block between two plates; the right one goes away, waits and comes back.
std::string pulled(const std::string& path) {
  return R"(
duration = 0.6
gravity = [0, 0, 0]
[body.bar]
shape = "box"
size = [0.1, 0.1, 0.1]
cells = [4, 4, 4]
young = 2e4
damping_ratio = 0
drag = 5
[pin.left]
select = { side = "-x" }
[pin.right]
select = { side = "+x" }
path = )" +
         path;
}

const char* there_and_back =
    "[{ time = 0.15, move = [0.2, 0, 0] }, { time = 0.25, move = [0.2, 0, 0] }, { time = 0.4 }]";

TEST(Adaptive, TheStepGrowsAgainWhenTheBodySoftens) {
  const Summary s = finished(pulled(there_and_back));
  EXPECT_GT(s.step_reductions, 0);
  EXPECT_GT(s.step_increases, 0);
  EXPECT_GT(s.dt, 1.2 * s.stable_step);  // the last step is far above the shortest stable one
  EXPECT_EQ(s.recovery_steps, 0);
}

// A given step that is stable at rest and not when stretched is divided, and comes back.
TEST(Adaptive, AGivenStepIsDividedWhileItIsTooLong) {
  const Summary free = finished(pulled(there_and_back));
  const std::string dt = "dt=" + std::to_string(1.25 * free.stable_step);
  const Summary s = finished(pulled(there_and_back), {dt});
  EXPECT_GT(s.step_reductions, 0);
  EXPECT_GT(s.step_increases, 0);
  EXPECT_NEAR(s.dt, 1.25 * free.stable_step, 1e-6);  // the given one again
  EXPECT_LT(s.peak_stretch, 1.2 * free.peak_stretch);
  EXPECT_NEAR(s.sim_seconds, 0.6, s.dt);
  ASSERT_EQ(s.warnings.size(), 1u);
  EXPECT_NE(s.warnings[0].find("was divided"), std::string::npos) << s.warnings[0];
}

TEST(Adaptive, AJerkToTwiceTheLengthStaysFinite) {
  for (const char* jerk : {"[{ time = 0.005, move = [0.1, 0, 0] }]",
                           "[{ time = 0.3 }, { time = 0.305, move = [0.1, 0, 0] }]",
                           "[{ time = 0.3 }, { time = 0.4, move = [0.1, 0, 0] }]"}) {
    for (const char* law : {"lloyd", "neo-hookean"}) {
      const Summary s =
          finished(pulled(jerk), {std::string("bar.law=") + law, "bar.damping_ratio=0.1"});
      EXPECT_LT(s.peak_stretch, 5.0) << law << jerk;
      EXPECT_LT(s.energy.kinetic, 1.0) << law << jerk;
    }
  }
}

TEST(Adaptive, ABodyPressedFlatStaysFinite) {
  const char* press =
      "[{ time = 0.02, move = [-0.099, 0, 0] }, { time = 0.2, move = [-0.099, 0, 0] }, "
      "{ time = 0.25 }]";
  for (const char* law : {"lloyd", "neo-hookean"}) {
    const Summary s =
        finished(pulled(press), {std::string("bar.law=") + law, "bar.damping_ratio=0.1"});
    EXPECT_LT(s.energy.kinetic, 1.0) << law;
  }
}

TEST(Adaptive, TheMostInvertedTetsOfAnyFrameAreCounted) {
  const Summary s = finished(pulled("[{ time = 0.6 }]"),
                             {"bar.start=inverted", "bar.poisson=0.3", "bar.damping_ratio=0.1"});
  EXPECT_GT(s.peak_inverted_tets, 150);  // frame 0
  EXPECT_EQ(s.inverted_tets, 0);
  EXPECT_GT(s.recovery_steps, 0);
}

}  // namespace
}  // namespace sinew
