// The scenes that Sinew comes with.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "sinew/solver/stable_step.h"
#include "sinew/solver/verlet.h"
#include "tests/scene/support.h"
#include "tests/support/effort.h"
#include "tests/support/source_dir.h"

namespace sinew {
namespace {

std::vector<std::filesystem::path> scene_files() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(test::source_path("scenes")))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

class Scenes : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(Scenes, SayWhatTheyAreAndBuild) {
  const Scene scene = load_scene(GetParam());
  EXPECT_FALSE(scene.title.empty());
  EXPECT_FALSE(scene.look_for.empty());
  EXPECT_FALSE(scene.probes.empty());
  BuildReport report;
  const Model model = build_model(scene, &report);
  EXPECT_GT(model.tet_count(), 0);
  // Those of the liver are known: its surface touches itself at a few edges.
  for (const BuildReport::Body& body : report.bodies)
    for (const std::string& warning : body.warnings)
      EXPECT_NE(warning.find("non-manifold edges"), std::string::npos)
          << body.name << ": " << warning;
}

TEST_P(Scenes, AreWhollyInTheirDocument) {
  const Scene scene = load_scene(GetParam());
  const Scene again = parse_scene(scene.document, "again.toml", scene.base);
  EXPECT_EQ(again.document, scene.document);
  EXPECT_EQ(build_model(again).hash(), build_model(scene).hash());
}

TEST_P(Scenes, HoldAtTheirStableStep) {
  if (test::sanitized && GetParam().stem() == "liver-fine") return;  // as liver.toml
  const Scene scene = load_scene(GetParam());
  const Model model = build_model(scene);
  VerletStepper stepper(model, Precision::double_);
  State state = initial_state(model);
  const double h =
      scene.safety *
      find_stable_step(model, initial_controls(model), state.position, stepper.forces()).step;
  for (int i = 0; i < test::effort(50); ++i) stepper.step(h, initial_controls(model), state);
}

// Runs a scene at the step it gives, or at its stable step, and returns the state at `time`.
State run_to(double time, const Scene& scene, const Model& model) {
  VerletStepper stepper(model, Precision::double_);
  State state = initial_state(model);
  const double stable =
      scene.safety *
      find_stable_step(model, initial_controls(model), state.position, stepper.forces()).step;
  const double h = scene.dt.value_or(0.5 * stable);
  while (state.time < time) stepper.step(h, initial_controls(model), state);
  return state;
}

Scene shipped(const std::string& name) {
  return load_scene(test::source_path("scenes/") + name);
}

double largest_stretch(const Model& model, const State& state) {
  double stretch = 0.0;
  for (std::size_t s = 0; s < model.springs.size(); ++s) {
    const Vec3 d = state.position[static_cast<std::size_t>(model.springs[s][1])] -
                   state.position[static_cast<std::size_t>(model.springs[s][0])];
    stretch = std::max(stretch, d.norm() / model.rest_length[s] - 1.0);
  }
  return stretch;
}

TEST(TalkScenes, BadConstantsBlowUpAndGoodOnesHold) {
  const Scene bad = shipped("talk-bad-constants.toml");
  const Scene good = shipped("talk-good-constants.toml");
  EXPECT_EQ(bad.dt, good.dt);
  EXPECT_TRUE(bad.allow_unstable);
  EXPECT_THROW(run_to(bad.duration, bad, build_model(bad)), Error);
  const Model model = build_model(good);
  EXPECT_LT(largest_stretch(model, run_to(good.duration, good, model)), 0.2);
}

TEST(TalkScenes, LimitsHoldTheTissue) {
  if (test::sanitized) return;  // thousands of steps of what the solver's tests run, too
  const Scene free = shipped("talk-tissue.toml");
  const Scene limited = shipped("talk-tissue-limits.toml");
  const Model free_model = build_model(free);
  const Model limited_model = build_model(limited);
  EXPECT_GT(largest_stretch(free_model, run_to(0.25, free, free_model)), 0.5);
  EXPECT_LT(largest_stretch(limited_model, run_to(0.25, limited, limited_model)), 0.1025);
}

TEST(TalkScenes, TheTalksConstants) {
  const Model model = build_model(shipped("talk-constants.toml"));
  EXPECT_DOUBLE_EQ(*std::min_element(model.stiffness.begin(), model.stiffness.end()), 2e5);
  EXPECT_DOUBLE_EQ(*std::max_element(model.stiffness.begin(), model.stiffness.end()), 2e5);
  EXPECT_DOUBLE_EQ(*std::min_element(model.damping.begin(), model.damping.end()), 3e3);
  EXPECT_DOUBLE_EQ(*std::max_element(model.damping.begin(), model.damping.end()), 3e3);
}

INSTANTIATE_TEST_SUITE_P(All, Scenes, testing::ValuesIn(scene_files()), [](const auto& test) {
  std::string name = test.param.stem().string();
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace sinew
