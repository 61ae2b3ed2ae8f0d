// The interface of all time steppers: one virtual call per step.
//
// A new stepper is a class of its own (a .h and a .cpp), a word in solver/stepper_kind.h and a line
// in make_stepper().
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sinew/forces/force_evaluator.h"
#include "sinew/model/controls.h"
#include "sinew/model/state.h"
#include "sinew/solver/deadline.h"
#include "sinew/solver/step_report.h"
#include "sinew/solver/stepper_kind.h"

namespace sinew {

// Conditions that end a step early.
struct Interrupt {
  Deadline deadline = {};  // implicit steps: the current iterate becomes the step
  // Rest states: end within a product of the current Newton step, with the best positions so far.
  const std::atomic<bool>* stop = nullptr;
  // Implicit steps: end as soon, and are not taken. Explicit steps are short.
  const std::atomic<bool>* cancel = nullptr;
  bool trial = false;  // an implicit step is given up after two cuts
};

// The data that a stepper keeps between steps in addition to the State. A checkpoint holds them.
struct StepMemory {
  double stable_step = no_limit;    // at the last estimate [s]; infinity: any step is stable
  std::vector<Vec3> stiff_mode;     // the mode that limits the step (nodes)
  std::int64_t steps_to_watch = 0;  // steps until the stable step is estimated again
  std::int64_t watch_interval = 0;  // interval between the last estimate and that one
};

// The step lengths that a stepper reports before the first step.
struct FirstStep {
  double stable = no_limit;   // the longest stable step [s]
  double longest = no_limit;  // the longest step that it chooses itself [s]
  std::string limited_by;     // the cause of the limit on the stable step
};

struct StepperOptions {
  Scheme scheme = Scheme::tr_bdf2;
  double tolerance = 1e-6;  // of rest states and implicit steps, see NewtonReport::residual
  Precision precision = Precision::single;
};

class Stepper {
 public:
  Stepper() = default;
  Stepper(const Stepper&) = delete;
  Stepper& operator=(const Stepper&) = delete;
  virtual ~Stepper() = default;

  // Called once at the start of a run, but not when a run is resumed, and after a cut: fills the
  // memory. One that is filled already, for these nodes, makes it quicker.
  virtual FirstStep begin(const Controls& controls, const State& state, StepMemory& memory) = 0;

  // Advances the state by h [s] > 0. Throws Error(diverged) if that fails; the state is then the
  // broken one.
  virtual StepReport step(double h, const Controls& controls, const Interrupt& interrupt,
                          State& state, StepMemory& memory) = 0;

  // Called before a step of length h [s], once or more often. Returns the stable step if it was
  // estimated again.
  virtual std::optional<double> watch(double h, const Controls& controls, const State& state,
                                      StepMemory& memory);

  // The longest stable step from here [s], including the limit from the forces of the last step;
  // infinity: any step is stable.
  virtual double stable_step(const StepMemory& memory) const { return memory.stable_step; }

  // Prepares steps of length h [s], before a deadline counts.
  virtual void prepare(double h, const Controls& controls);

  // Whether steps lead to rest states: their length is the frame's, whatever dt is.
  virtual bool finds_rest() const { return false; }

  // Evaluates forces in the precision of the steps, for measurements between them. Earlier
  // evaluations never affect a step.
  virtual ForceEvaluator& forces() = 0;
};

// The model must outlive the stepper. Throws Error(internal) for StepperKind::automatic.
std::unique_ptr<Stepper> make_stepper(StepperKind kind, const Model& model,
                                      const StepperOptions& options);

}  // namespace sinew
