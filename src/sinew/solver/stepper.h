// A method that takes steps, behind one interface: one virtual call a step.
//
// A new stepper is a class of its own (a .h and a .cpp), its word in solver/stepper_kind.h and a
// line in make_stepper().
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sinew/forces/workspace.h"
#include "sinew/model/controls.h"
#include "sinew/model/state.h"
#include "sinew/solver/deadline.h"
#include "sinew/solver/stepper_kind.h"

namespace sinew {

// What a step took and what it left. sim/run_counters.h says how these add up over a run.
struct StepReport {
  int newton = 0;                 // steps of Newton's method
  int products = 0;               // Hessian products they took
  int cuts = 0;                   // times that the step was cut in half
  double residual = 0.0;          // the largest left, see NewtonReport::residual [-]
  bool ran_out = false;           // of time, see Interrupt::deadline
  bool stopped = false;           // by Interrupt::stop: the step is not done
  Index contacts = 0;             // places that touch at the end
  double deepest = 0.0;           // a place was left inside what it touched [m]
  double friction = 0.0;          // work of friction in contacts [J]
  int limit_sweeps = 0;           // sweeps that moved a spring
  bool limits_met = true;         // contacts and limits hold to their tolerances
  int recovered = 0;              // bodies with inversion recovery (forces/inversion_recovery.h)
  double stable_step = no_limit;  // what the forces of this step allow the next one [s]
};

// What may end a step before it is done.
struct Interrupt {
  Deadline deadline = {};                   // implicit steps: the iterate of that time is the step
  const std::atomic<bool>* stop = nullptr;  // rest states: ends after the Newton step under way
};

// What a stepper remembers from step to step beside the State. A checkpoint holds it.
struct StepMemory {
  double stable_step = no_limit;    // when last estimated [s]; infinity: any step is stable
  std::vector<Vec3> stiff_mode;     // the mode that limits the step (nodes)
  std::int64_t steps_to_watch = 0;  // steps until the stable step is estimated again
  std::int64_t watch_interval = 0;  // steps from the last estimate to that one
};

// What a stepper says about its steps before the first one.
struct FirstStep {
  double stable = no_limit;   // the longest stable step [s]
  double longest = no_limit;  // the longest step that it takes by itself [s]
  std::string limited_by;     // what makes the stable step as short as it is
};

struct StepperOptions {
  Scheme scheme = Scheme::sdirk2;
  double tolerance = 1e-6;  // of rest states and implicit steps, see NewtonReport::residual
  Precision precision = Precision::single;
};

class Stepper {
 public:
  Stepper() = default;
  Stepper(const Stepper&) = delete;
  Stepper& operator=(const Stepper&) = delete;
  virtual ~Stepper() = default;

  // Called once at the start of a run, not where a run goes on: fills the memory.
  virtual FirstStep begin(const Controls& controls, const State& state, StepMemory& memory) = 0;

  // Advances the state by h [s] > 0. Throws Error(diverged) where that fails; the state is then the
  // broken one.
  virtual StepReport step(double h, const Controls& controls, const Interrupt& interrupt,
                          State& state, StepMemory& memory) = 0;

  // Called before a step of length h [s], once or more often. Returns the stable step where it was
  // estimated anew.
  virtual std::optional<double> watch(double h, const Controls& controls, const State& state,
                                      StepMemory& memory);

  // The longest stable step from here [s], with what the forces of the last step allow; infinity:
  // any.
  virtual double stable_step(const StepMemory& memory) const { return memory.stable_step; }

  // Does now what steps of length h [s] need and a deadline should not pay for.
  virtual void prepare(double h, const Controls& controls);

  // Whether steps lead to rest states: as long as the frame, whatever dt says.
  virtual bool finds_rest() const { return false; }

  virtual Workspace& workspace() = 0;
};

// The model must outlive the stepper. Throws Error(internal) for StepperKind::automatic.
std::unique_ptr<Stepper> make_stepper(StepperKind kind, const Model& model,
                                      const StepperOptions& options);

}  // namespace sinew
