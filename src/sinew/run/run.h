// A run of a scene into a folder: from its start, or resumed from a checkpoint.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sinew/base/error.h"
#include "sinew/base/vec.h"
#include "sinew/run/summary.h"
#include "sinew/scene/scene.h"

namespace sinew {

struct Progress {
  double sim_seconds = 0.0;
  double duration = 0.0;
  double wall_seconds = 0.0;   // of this run, from before the first step
  double start_seconds = 0.0;  // simulated time at which this run began (resumed: not 0)
  std::int64_t frame = 0;
  std::int64_t frames = 0;
};

struct RunOptions {
  std::filesystem::path out;                         // output folder; empty: nothing is written
  bool force = false;                                // an earlier run in `out` may be replaced
  const std::atomic<bool>* stop = nullptr;           // true ends the run after the current step
  std::function<void(const Progress&)> on_progress;  // called after every frame
  // Called before the first step of stepper = "auto" with RunState::stepper and the reason.
  std::function<void(StepperKind, const std::string&)> on_stepper;
  // Called once the scene is built, before the first file is written.
  std::function<void()> on_start;
  // True while steps are taken: a process that ends then loses them alone, and its folder can be
  // resumed from the last checkpoint.
  std::atomic<bool>* stepping = nullptr;
  // Called before the first step with each warning about the scene, those about units and bodies
  // that cannot keep their shape first. The summary has them too.
  std::function<void(const std::string&)> on_warning;
};

struct RunResult {
  RunStatus status = RunStatus::finished;
  Summary summary;
  std::optional<Error> error;                 // of a run that diverged
  std::vector<Vec3> rest_position, position;  // of the bodies' nodes, at the end [m]
};

// Writes scene.toml (the scene with its overrides, from which the run can be resumed), NAME.pvd and
// frames/*.vtu, probes.csv, energy.csv, frames.csv, checkpoint.bin, summary.json. Throws
// Error(input) for a scene that cannot be built, Error(unstable) for a step above the stable one,
// Error(usage) if `out` holds a run or other files (run/folder.h), or another run is writing there,
// Error(io). A run that diverges does not throw: its last good
// frame, checkpoint and summary are kept.
RunResult run_scene(const Scene& scene, const RunOptions& options);

// Continues the run in `folder` from its checkpoint and ends with the same bits as an unbroken run.
// options.out and force are ignored. Another duration and other output than at the start take
// effect. Throws Error(input) if there is nothing to resume, or if the scene was edited in a way
// that changes the run (run/scene_changes.h); Error(usage) if another run is writing there.
RunResult resume_run(const std::filesystem::path& folder, const RunOptions& options);

// The exit code of the process for a result: 0, 130 (interrupted) or that of the error.
int exit_code(const RunResult& result);

}  // namespace sinew
