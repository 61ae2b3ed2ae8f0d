// stepper = "auto" and budget_ms.
#include <gtest/gtest.h>

#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <sstream>
#include <string>

#include "sinew/base/parallel.h"
#include "sinew/io/file_io.h"
#include "sinew/run/run.h"

namespace sinew {
namespace {

namespace fs = std::filesystem;

const char* cantilever = R"(
duration = 0.2
stepper = "auto"
[output]
checkpoint = 0
vtu = false
[body.beam]
shape = "beam"
cells = [2, 2, 6]
[pin.wall]
select = { side = "-z" }
[probe.tip]
select = { side = "+z" }
)";

// A block whose end a hand throws about, one place every 50 ms.
const char* thrown = R"(
duration = 3
stepper = "implicit"
budget_ms = 0.001
[output]
fps = 60
vtu = false
[body.block]
shape = "box"
size = [0.1, 0.1, 0.2]
cells = [3, 3, 6]
young = 1e4
[pin.wall]
select = { side = "-z" }
[pin.hand]
select = { side = "+z" }
path = [
  { time = 0.05, move = [0.05, 0, 0] }, { time = 0.1, move = [-0.05, 0.04, 0] },
  { time = 0.15, move = [0, -0.05, 0.08] }, { time = 0.2, move = [0, 0.03, -0.08] },
  { time = 0.25, move = [0.05, 0, 0.05] }, { time = 0.3, turn = [0, 0, 60] },
  { time = 0.35, turn = [0, 40, -60] }, { time = 0.4 },
]
)";

Scene scene_of(const char* text, const std::vector<std::string>& overrides = {}) {
  return parse_scene(text, "auto.toml", fs::temp_directory_path(), overrides);
}

Summary run_of(const char* text, const std::vector<std::string>& overrides = {}) {
  const RunResult result = run_scene(scene_of(text, overrides), {});
  EXPECT_EQ(result.status, RunStatus::finished);
  return result.summary;
}

class Auto : public testing::Test {
 protected:
  void SetUp() override { fs::remove_all(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  const fs::path folder_ = fs::temp_directory_path() / ("sinew-auto-" + std::to_string(::getpid()));
};

TEST_F(Auto, TakesVerletForSoftTissueAndImplicitStepsForStiffOnes) {
  const Summary soft = run_of(cantilever, {"beam.young=3e3"});
  EXPECT_EQ(soft.stepper, StepperKind::verlet);
  EXPECT_EQ(soft.stepper_asked, StepperKind::automatic);
  EXPECT_TRUE(soft.stepper_reason.starts_with("verlet: stable step ")) << soft.stepper_reason;
  const Summary stiff = run_of(cantilever, {"beam.young=1e9"});
  EXPECT_EQ(stiff.stepper, StepperKind::implicit);
  EXPECT_NE(stiff.stepper_reason.find("; implicit: "), std::string::npos) << stiff.stepper_reason;
}

TEST_F(Auto, TheChoiceRunsAsIfItHadBeenAskedFor) {
  for (const char* young : {"beam.young=3e3", "beam.young=1e9"}) {
    const Summary chosen = run_of(cantilever, {young});
    const Summary asked =
        run_of(cantilever, {young, "stepper=" + std::string(word_of(chosen.stepper))});
    EXPECT_EQ(chosen.state_hash, asked.state_hash);
    EXPECT_EQ(asked.stepper_reason, "");
  }
}

TEST_F(Auto, TheReasonIsTheSameForAnyNumberOfThreads) {
  const auto reason = [](int threads) {
    const ThreadLimit limit(threads);
    return run_of(cantilever, {"beam.young=1e6", "duration=0.01"}).stepper_reason;
  };
  EXPECT_EQ(reason(1), reason(2));
}

TEST_F(Auto, WhatOnlyOneStepperKnowsDecides) {
  const Summary s =
      run_of(cantilever, {"beam.young=1e9", "duration=0.01", "ground.restitution=0.5"});
  EXPECT_EQ(s.stepper, StepperKind::verlet);
  EXPECT_NE(s.stepper_reason.find("implicit steps ignore"), std::string::npos) << s.stepper_reason;
  // What both know leaves it to the work.
  for (const char* feature : {"ground.friction=0.5", "beam.stretch_limit=0.5",
                              "beam.volume_limit=0.01", "beam.start=inverted"}) {
    const Summary known = run_of(cantilever, {"beam.young=1e9", "duration=0.01", feature});
    EXPECT_EQ(known.stepper, StepperKind::implicit) << feature;
    EXPECT_TRUE(known.stepper_reason.starts_with("verlet: stable step ")) << known.stepper_reason;
  }
  EXPECT_EQ(run_of(cantilever, {"dt=0.02"}).stepper, StepperKind::implicit);
  EXPECT_EQ(run_of(cantilever, {"beam.young=3e3", "budget_ms=50"}).stepper, StepperKind::implicit);
}

TEST_F(Auto, ResumeGoesOnWithTheSameStepper) {
  for (const char* young : {"beam.young=3e3", "beam.young=1e9"}) {
    fs::remove_all(folder_);
    const Summary whole = run_of(cantilever, {young});
    std::atomic<bool> stop{false};
    RunOptions options;
    options.out = folder_;
    options.stop = &stop;
    options.on_progress = [&](const Progress& p) { stop = p.frame == 2; };
    ASSERT_EQ(run_scene(scene_of(cantilever, {young}), options).status, RunStatus::interrupted);
    std::string said;
    RunOptions listen;
    listen.on_stepper = [&](StepperKind, const std::string& reason) { said = reason; };
    const RunResult rest = resume_run(folder_, listen);
    EXPECT_EQ(rest.summary.stepper, whole.stepper);
    EXPECT_EQ(rest.summary.stepper_reason, whole.stepper_reason);
    EXPECT_EQ(said, whole.stepper_reason);
    EXPECT_EQ(rest.summary.state_hash, whole.state_hash);
  }
}

// The smallest budget there is: one product a step, wherever the hand goes.
TEST_F(Auto, AStepCutShortByItsBudgetKeepsTheBodyTogether) {
  RunOptions options;
  options.out = folder_;
  const RunResult result = run_scene(scene_of(thrown), options);
  ASSERT_EQ(result.status, RunStatus::finished);
  const Summary& s = result.summary;
  ASSERT_TRUE(s.budget.has_value());
  EXPECT_GT(s.budget->cut_short, 80);
  EXPECT_EQ(s.step_cuts, 0);
  EXPECT_EQ(s.steps, 180);                // one a frame
  EXPECT_EQ(s.products, s.newton_steps);  // of each Newton step one
  EXPECT_GE(s.budget->largest_ms, s.budget->percentile_99_ms);
  EXPECT_GT(s.budget->largest_residual, 1e-6);
  EXPECT_LT(s.peak_stretch, 5.0);
  const auto json = to_json(s);
  EXPECT_EQ(json["reproducible"], false);
  EXPECT_EQ(json["budget"]["ms"], 0.001);
  // When the hand has come back and rests, so does the block, near where it would rest anyway.
  const double carried = s.energy.elastic + std::abs(s.energy.gravity);
  EXPECT_LT(s.energy.kinetic, 0.05 * carried);

  std::istringstream table(io::read_file(folder_ / "frames.csv"));
  std::string line;
  std::getline(table, line);
  EXPECT_EQ(line, "frame,time [s],wall [ms],steps,newton_steps,products,residual,cut_short");
  int rows = 0;
  while (std::getline(table, line)) ++rows;
  EXPECT_EQ(rows, 181);
}

TEST_F(Auto, ABudgetThatIsNeverReachedChangesNothing) {
  const Summary free = run_of(thrown, {"budget_ms=1e6", "duration=0.2"});
  EXPECT_EQ(free.budget->cut_short, 0);
  EXPECT_LE(free.budget->largest_residual, 0.01);
}

TEST_F(Auto, ResumeGoesOnWithABudget) {
  std::atomic<bool> stop{false};
  RunOptions options;
  options.out = folder_;
  options.stop = &stop;
  options.on_progress = [&](const Progress& p) { stop = p.frame == 5; };
  ASSERT_EQ(run_scene(scene_of(thrown, {"duration=0.2"}), options).status, RunStatus::interrupted);
  const RunResult rest = resume_run(folder_, {});
  EXPECT_EQ(rest.status, RunStatus::finished);
  EXPECT_EQ(rest.summary.frames, 12);
  EXPECT_EQ(rest.summary.steps, 12);
}

}  // namespace
}  // namespace sinew
