// Divides time into frames and frames into steps: of a given length, or as long as the stable step
// allows; or rest states, one a frame. Steppers are used only through their interface
// (solver/stepper.h). RunState holds everything that decides the next step, so that a run can be
// interrupted at any step and continue with the same bits.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "sinew/model/controls.h"
#include "sinew/sim/run_state.h"
#include "sinew/sim/stepping_options.h"

namespace sinew {

class Stepping {
 public:
  // Chooses the stepper (sim/choose_stepper.h) unless `run` names the one in use. Throws
  // Error(unstable) if the given step is above the stable one and the options do not allow that.
  // The model must outlive the object.
  Stepping(const SteppingOptions& options, const Model& model, const Controls& controls,
           RunState& run);
  Stepping(const Scene& scene, const Model& model, const Controls& controls, RunState& run)
      : Stepping(stepping_options(scene), model, controls, run) {}

  // All of these throw Error(diverged), see verlet_step and StaticSolver::solve. `stop` ends them
  // after the current step, and ends the search for a rest state before it is found.

  // Takes the next step. Returns true when the frame is finished.
  bool step(const Controls& controls, RunState& run, const std::atomic<bool>* stop = nullptr);

  // Steps to the end of the frame. Returns true when that is reached.
  bool advance_frame(const Controls& controls, RunState& run, const std::atomic<bool>* stop);

  // Whether SteppingOptions::cancel is set: no implicit step is taken.
  bool cancelled() const { return options_.cancel != nullptr && options_.cancel->load(); }

  // Steps towards `end` [s]: to the end of the current frame if that is not later, otherwise to
  // `end` itself (with a given dt: the nearest step), which may be within a frame.
  enum class Progress { arrived, frame, stopped };
  Progress advance_to(const Controls& controls, RunState& run, double end,
                      const std::atomic<bool>* stop);

  // Takes one step of h [s] > 0, regardless of the ends of frames.
  void take_step(const Controls& controls, RunState& run, double h);

  // Throws Error(unstable) if a step must not be as long as h [s].
  void require_stable(const Controls& controls, RunState& run, double h);

  // The length of the step that step() takes next [s].
  double prepare(const Controls& controls, RunState& run);

  // The longest step now that is stable and keeps the energy [s]; infinity: any.
  double longest_step(const RunState& run) const {
    return share_ * stepper_->stable_step(run.memory);
  }
  // Not empty: a given step is longer than explicit steps that keep the energy, and is divided.
  std::string division(const RunState& run) const;

  // Estimates the stable step of another model that the run continues with, and plans the rest of
  // the frame by it.
  void choose_step_again(const Controls& controls, RunState& run);

  // Continues the run at the time of its state, which was set from outside.
  void resume_at(RunState& run) const;

  // Number of frames up to the end; the largest integer if there is no end.
  std::int64_t frame_count() const { return frames_; }
  // Between the ends of frames [s], also where rest states need only one.
  double frame_interval() const { return frame_interval_; }
  ForceEvaluator& forces() { return stepper_->forces(); }
  // The cause of the limit on the stable step, when the run began; empty for a resumed run.
  const std::string& limited_by() const { return limited_by_; }

 private:
  bool automatic() const { return !options_.dt; }
  double frame_end(std::int64_t frame) const;
  void begin_run(const Controls& controls, RunState& run);
  void begin_frame(RunState& run) const;
  void finish_frame(RunState& run) const;
  void plan(RunState& run, double end, std::int64_t given_steps) const;
  void watch(const Controls& controls, RunState& run);
  void adapt(double stable, RunState& run);
  bool one_step(const Controls& controls, RunState& run, const std::atomic<bool>* stop);
  bool steps(const Controls& controls, RunState& run, const std::atomic<bool>* stop);
  void shorten(RunState& run, double step) const;
  bool too_long(const RunState& run, double stable, double slack) const;

  const Model& model_;
  SteppingOptions options_;  // interval: of the frames that are stepped to
  double frame_interval_ = 0.0;
  double share_ = 1.0;  // of the stable step that a given step may take (accurate_share())
  std::unique_ptr<Stepper> stepper_;
  std::int64_t frames_ = 0;
  std::string limited_by_;
};

}  // namespace sinew
