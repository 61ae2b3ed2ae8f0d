#include "sinew/run/run.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "sinew/io/file_io.h"
#include "sinew/io/vtu.h"
#include "sinew/run/checkpoint_file.h"
#include "sinew/scene/build.h"

namespace sinew {
namespace {

namespace fs = std::filesystem;

const char* hanging_box = R"(
duration = 0.2
[output]
checkpoint = 0
[body.box]
shape = "box"
cells = [3, 3, 3]
size = [0.1, 0.1, 0.1]
young = 2e4
[pin.top]
select = { side = "+y" }
[probe.bottom]
select = { side = "-y" }
)";

Scene hanging_scene(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return parse_scene(text, "hanging.toml", fs::temp_directory_path(), overrides);
}

class Run : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() /
              (std::string("sinew-run-") + test->name() + "-" + std::to_string(::getpid()));
    fs::remove_all(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  RunOptions into_folder() const {
    RunOptions options;
    options.out = folder_;
    return options;
  }
  std::vector<std::string> lines(const std::string& name) const {
    std::istringstream in(io::read_file(folder_ / name));
    std::vector<std::string> rows;
    for (std::string line; std::getline(in, line);) rows.push_back(line);
    return rows;
  }
  fs::path folder_;
};

TEST_F(Run, WritesEverythingItPromises) {
  const RunResult result = run_scene(hanging_scene(hanging_box), into_folder());
  EXPECT_EQ(result.status, RunStatus::finished);
  EXPECT_EQ(exit_code(result), 0);
  for (const char* name :
       {"scene.toml", "hanging.pvd", "frames/hanging_0000.vtu", "frames/hanging_0006.vtu",
        "probes.csv", "energy.csv", "checkpoint.bin", "summary.json"}) {
    EXPECT_TRUE(fs::exists(folder_ / name)) << name;
  }
  EXPECT_EQ(lines("probes.csv").size(), 1u + 7u);  // header, frames 0 to 6
  EXPECT_EQ(lines("energy.csv").size(), 1u + 7u);
  const auto summary = nlohmann::json::parse(io::read_file(folder_ / "summary.json"));
  for (const char* key : {"version", "scene", "scene_hash", "mesh", "laws", "stepper", "dt",
                          "steps", "sim_seconds", "wall_seconds", "realtime_factor", "energy",
                          "volume_ratio", "max_stretch", "max_compress", "state_hash", "probes"}) {
    EXPECT_TRUE(summary.contains(key)) << key;
  }
  for (const char* key : {"kinetic", "elastic", "gravity", "dissipated", "work_in"}) {
    EXPECT_TRUE(summary["energy"].contains(key)) << key;
  }
  EXPECT_EQ(summary["mesh"]["nodes"], 64);
  EXPECT_EQ(summary["mesh"]["tets"], 162);
  EXPECT_EQ(summary["mesh"]["springs"], 279);
  EXPECT_NEAR(summary["sim_seconds"], 0.2, 1e-12);
  EXPECT_LT(summary["probes"]["bottom"]["displacement"][1], -1e-4);
}

TEST_F(Run, TheLastFrameIsTheState) {
  const RunResult result = run_scene(hanging_scene(hanging_box), into_folder());
  const TetMesh frame = io::parse_vtu(io::read_file(folder_ / "frames/hanging_0006.vtu"), "frame");
  ASSERT_EQ(frame.node_count(), 64);
  Vec3 mean = Vec3::Zero();
  int count = 0;
  const Model model = build_model(hanging_scene(hanging_box));
  for (Index i = 0; i < 64; ++i) {
    if (model.rest_position[uz(i)].y() > -0.05 + 1e-9) continue;
    mean += frame.nodes[uz(i)];
    ++count;
  }
  EXPECT_LT((mean / count - result.summary.probes[0].position).norm(), 1e-7);  // Float32
}

TEST_F(Run, ResumeAfterAStopEndsWithTheSameBits) {
  const Scene scene = hanging_scene(hanging_box);
  const RunResult whole = run_scene(scene, {});
  for (const int stop_after : {0, 1, 3}) {
    fs::remove_all(folder_);
    std::atomic<bool> stop{stop_after == 0};
    RunOptions options = into_folder();
    options.stop = &stop;
    options.on_progress = [&](const Progress& p) { stop = p.frame >= stop_after; };
    const RunResult part = run_scene(scene, options);
    ASSERT_EQ(part.status, RunStatus::interrupted);
    EXPECT_EQ(exit_code(part), 130);
    const RunResult rest = resume_run(folder_, {});
    EXPECT_EQ(rest.status, RunStatus::finished);
    EXPECT_EQ(rest.summary.state_hash, whole.summary.state_hash);
    EXPECT_EQ(rest.summary.scene_hash, whole.summary.scene_hash);
    EXPECT_EQ(rest.summary.steps, whole.summary.steps);
    EXPECT_EQ(rest.summary.energy.dissipated, whole.summary.energy.dissipated);
    EXPECT_EQ(lines("probes.csv").size(), 1u + 7u);
  }
}

// What the ground and the limits push with goes from step to step, and so into the checkpoint.
TEST_F(Run, ImplicitStepsOnTheGroundResumeToTheSameBits) {
  const Scene scene = hanging_scene(R"(
stepper = "implicit"
duration = 0.2
[output]
checkpoint = 0
[ground]
point = [0, -0.06, 0]
normal = [0.1, 1, 0]
restitution = 0.1
[body.box]
shape = "box"
cells = [2, 2, 2]
size = [0.1, 0.1, 0.1]
center = true
young = 2e4
stretch_limit = 0.1
volume_limit = 0.01
)");
  const RunResult whole = run_scene(scene, {});
  EXPECT_GT(whole.summary.contacts, 0);
  EXPECT_GT(whole.summary.energy.dissipated, 0.0);
  EXPECT_EQ(whole.summary.unmet_limits, 0);
  EXPECT_LE(whole.summary.largest_cell_change, 0.0101);
  ASSERT_EQ(whole.summary.warnings.size(), 2u);  // and that implicit contacts lose energy
  EXPECT_NE(whole.summary.warnings[0].find("restitution"), std::string::npos);
  std::atomic<bool> stop{false};
  RunOptions options = into_folder();
  options.stop = &stop;
  options.on_progress = [&](const Progress& p) { stop = p.frame >= 4; };
  ASSERT_EQ(run_scene(scene, options).status, RunStatus::interrupted);
  const RunResult rest = resume_run(folder_, {});
  EXPECT_EQ(rest.summary.state_hash, whole.summary.state_hash);
  EXPECT_EQ(rest.summary.energy.dissipated, whole.summary.energy.dissipated);
}

TEST_F(Run, ResumingAFinishedRunChangesNothing) {
  const RunResult whole = run_scene(hanging_scene(hanging_box), into_folder());
  const std::vector<std::string> rows = lines("energy.csv");
  const RunResult again = resume_run(folder_, {});
  EXPECT_EQ(again.summary.state_hash, whole.summary.state_hash);
  EXPECT_EQ(lines("energy.csv"), rows);
}

TEST_F(Run, RowsWrittenAfterTheCheckpointAreDropped) {
  std::atomic<bool> stop{false};
  RunOptions options = into_folder();
  options.stop = &stop;
  options.on_progress = [&](const Progress& p) { stop = p.frame == 2; };
  run_scene(hanging_scene(hanging_box), options);
  std::ofstream(folder_ / "probes.csv", std::ios::app) << "0.1,9,9\n0.13,tor";  // a killed run's
  resume_run(folder_, {});
  const std::vector<std::string> rows = lines("probes.csv");
  ASSERT_EQ(rows.size(), 1u + 7u);
  for (const std::string& row : rows) EXPECT_EQ(row.find(",9,9"), std::string::npos);
}

TEST_F(Run, AFolderWithARunIsNotOverwrittenUnasked) {
  run_scene(hanging_scene(hanging_box), into_folder());
  EXPECT_THROW(run_scene(hanging_scene(hanging_box), into_folder()), Error);
  RunOptions force = into_folder();
  force.force = true;
  EXPECT_EQ(run_scene(hanging_scene(hanging_box, {"duration=0.1"}), force).status,
            RunStatus::finished);
  EXPECT_FALSE(fs::exists(folder_ / "frames/hanging_0006.vtu"));
}

TEST_F(Run, AGivenStepAboveTheStableOneIsRefusedWithTheRemedies) {
  try {
    run_scene(hanging_scene(hanging_box, {"dt=0.02", "box.law=lloyd"}), {});
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::unstable);
    EXPECT_NE(e.message().find("the step 0.02 s is above the largest stable one, "),
              std::string::npos);
    EXPECT_NE(e.message().find("the stiffest spring is spring "), std::string::npos);
    for (const char* part : {"a smaller step (dt <= ", "more substeps (substeps = ",
                             "a softer material or a coarser mesh", "allow_unstable = true"}) {
      EXPECT_NE(e.remedy().find(part), std::string::npos) << part;
    }
  }
}

TEST_F(Run, TheSubstepsOfTheRefusalAreEnough) {
  std::string substeps;
  try {
    run_scene(hanging_scene(hanging_box, {"dt=0.02"}), {});
  } catch (const Error& e) {
    const std::size_t at = e.remedy().find("substeps = ") + 11;
    substeps = e.remedy().substr(at, e.remedy().find(')', at) - at);
  }
  const RunResult result =
      run_scene(hanging_scene(hanging_box, {"dt=0.02", "substeps=" + substeps}), {});
  EXPECT_EQ(result.status, RunStatus::finished);
  EXPECT_NEAR(result.summary.sim_seconds, 0.2, 1e-9);
}

TEST_F(Run, AnUnstableRunThatIsAllowedStopsAndKeepsItsLastGoodCheckpoint) {
  const RunResult result = run_scene(
      hanging_scene(hanging_box, {"dt=0.02", "allow_unstable=true", "duration=20"}), into_folder());
  EXPECT_EQ(result.status, RunStatus::diverged);
  EXPECT_EQ(exit_code(result), 5);
  ASSERT_TRUE(result.error.has_value());
  EXPECT_NE(result.error->message().find("body box, node "), std::string::npos);
  const Scene scene = load_scene(folder_ / "scene.toml");
  const Model model = build_model(scene);
  const fs::path file = folder_ / "checkpoint.bin";
  const RunState kept = state_of(read_run_checkpoint(file), file, model);
  for (const Vec3& x : kept.state.position) EXPECT_TRUE(x.allFinite());
  const auto summary = nlohmann::json::parse(io::read_file(folder_ / "summary.json"));
  EXPECT_EQ(summary["status"], "diverged");
}

TEST_F(Run, TheStepFollowsAStretchThatStiffens) {
  const char* pulled = R"(
duration = 1
[body.bar]
shape = "box"
size = [0.1, 0.1, 0.1]
cells = [4, 4, 4]
law = "lloyd"
young = 2e4
damping_ratio = 0
[pin.left]
select = { side = "-x" }
[pin.right]
select = { side = "+x" }
path = [{ time = 1, move = [1.0, 0, 0] }]
)";
  const RunResult result = run_scene(hanging_scene(pulled), {});
  EXPECT_EQ(result.status, RunStatus::finished);
  EXPECT_GT(result.summary.step_reductions, 0);
  EXPECT_LT(result.summary.max_stretch, 40.0);
}

TEST_F(Run, NothingToResumeIsAnError) {
  EXPECT_THROW(resume_run(folder_, {}), Error);
}

}  // namespace
}  // namespace sinew
