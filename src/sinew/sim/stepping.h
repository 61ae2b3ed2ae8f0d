// Chooses the steps of a run: fixed, or as the stable step asks; or rest states, one per frame.
// Everything that decides the next step is in RunState, so that a run can be cut anywhere and go on
// to the same bits.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sinew/forces/workspace.h"
#include "sinew/model/controls.h"
#include "sinew/model/state.h"
#include "sinew/scene/scene.h"
#include "sinew/solver/implicit.h"
#include "sinew/solver/stable_step.h"
#include "sinew/solver/static.h"

namespace sinew {

// What the steps of one frame took: of the frame under way, or of the last one finished.
struct FrameWork {
  double seconds = 0.0;           // of wall time
  std::int64_t steps = 0;         // [1]
  std::int64_t newton_steps = 0;  // of rest states and implicit steps
  std::int64_t products = 0;      // Hessian products they took
  double residual = 0.0;          // the largest that was left [-]
  std::int64_t cut_short = 0;     // steps that budget_ms ended before their tolerance was reached
};

// State, plus where the run stands: all that a checkpoint holds.
struct RunState {
  State state;
  std::string stepper;          // the one that runs: verlet, implicit, static; empty: to be chosen
  std::string stepper_reason;   // of stepper = "auto": why
  std::int64_t frame = 0;       // frames finished; frame 0 is the start
  std::int64_t steps_left = 0;  // steps to the end of the frame under way
  std::int64_t steps_to_watch = 0;    // steps until the stable step is looked at again
  std::int64_t watch_interval = 0;    // steps from the last look to that one
  double step = 0.0;                  // h now taken [s]
  double target_step = 0.0;           // the longest h that may be taken [s]
  double stable_step = 0.0;           // h_c when last looked at [s]
  double smallest_stable_step = 0.0;  // over the run [s]
  std::vector<Vec3> stiff_mode;       // the mode that limits the step (nodes)
  std::int64_t step_reductions = 0;   // times that the step was made shorter during the run
  std::int64_t step_increases = 0;    // times that it was made longer again
  std::int64_t step_cuts = 0;         // times that an implicit step was cut in half
  std::int64_t limit_sweeps = 0;      // sweeps over limited springs in all
  std::int64_t unmet_limits = 0;      // steps that ended with a limit violated
  std::int64_t righting_steps = 0;    // steps in which a tangled body was led back
  std::int64_t contacts = 0;          // places that touched in the last step
  double deepest = 0.0;               // a place was left inside what it touched, of all steps [m]
  double depth = 0.0;                 // the same of the last step [m]
  double friction_work = 0.0;         // of contacts, over the run [J]
  std::int64_t newton_steps = 0;      // of rest states and implicit steps, in all
  std::int64_t products = 0;          // Hessian products it took, in all
  double residual = 0.0;       // of the last rest state, or the largest of the implicit steps [-]
  double peak_stretch = 0.0;   // over the frames [-]
  double peak_compress = 0.0;  // over the frames [-]
  std::int64_t peak_inverted_tets = 0;  // over the frames
  double start_energy = 0.0;            // total at the start [J]
  double wall_seconds = 0.0;            // spent so far
  std::vector<double> frame_times;      // of the frames written [s]
  FrameWork work;
  std::int64_t frames_cut_short = 0;  // frames with steps that budget_ms ended
  std::vector<double> frame_seconds;  // FrameWork::seconds of every frame, where there is a budget
};

class Stepping {
 public:
  // stepper = "verlet": checks the scene's dt against the stable step of the model as it starts.
  // Throws Error(unstable) where dt / substeps is above it and the scene does not allow that.
  // stepper = "auto": sets run.stepper and its reason, unless a checkpoint has.
  Stepping(const Scene& scene, const Model& model, const Controls& controls, RunState& run);

  // Runs to the end of the next frame, or until `stop` is set after a step. Returns true when the
  // frame is finished. Throws Error(diverged), see verlet_step and StaticSolver::solve.
  bool advance_frame(const Controls& controls, RunState& run, const std::atomic<bool>* stop);

  std::int64_t frame_count() const { return frames_; }
  Workspace& workspace() { return workspace_; }

 private:
  double frame_end(std::int64_t frame) const;
  void choose(const Scene& scene, const Controls& controls, const StableStep& stable,
              double implicit_step, RunState& run);
  double verlet_step_at(double stable) const;
  void begin_frame(RunState& run) const;
  void implicit_steps(const Controls& controls, RunState& run, const std::atomic<bool>* stop);
  void verlet_steps(const Controls& controls, RunState& run, const std::atomic<bool>* stop);
  void watch(const Controls& controls, RunState& run);
  void shorten(RunState& run, double step) const;
  void watch_guard(RunState& run) const;
  bool too_long(const RunState& run, double stable, double slack) const;
  bool rest_frame(const Controls& controls, RunState& run, const std::atomic<bool>* stop);

  const Model& model_;
  Workspace workspace_;
  bool automatic_;
  double given_ = 0.0;  // dt / substeps [s]; not where automatic_
  bool allow_unstable_;
  double safety_;
  double duration_;
  double interval_;  // between frames [s]
  std::int64_t frames_;
  double tolerance_;                           // of rest states and implicit steps
  std::optional<double> budget_;               // wall time of a frame's steps [s]
  std::unique_ptr<StaticSolver> static_;       // stepper = "static"
  std::unique_ptr<ImplicitStepper> implicit_;  // stepper = "implicit"
  ImplicitOptions implicit_options_;
};

}  // namespace sinew
