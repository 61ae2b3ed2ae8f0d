// The policy that chooses a stepper and states the reason. docs/methods/auto.md.
//
// stepper = "auto" takes the stepper with less work for this scene. Explicit steps are counted from
// the stable step, implicit ones measured by trial steps of the model. If steps must keep up with
// the clock (Pace), explicit steps are taken as long as they do.
#pragma once

#include <memory>
#include <string>

#include "sinew/sim/stepping_options.h"

namespace sinew {

// The cost of the parts of an implicit step, in Verlet steps in double precision on the same model.
// Fitted to runs of the network law on W(4), W(8) and the liver; they predict the cost of implicit
// steps of 14 to 69 Verlet steps within 30 %. The choice uses counted work times these constants
// instead of wall time, so a scene takes the same stepper on every machine.
inline constexpr double step_cost = 6.0;     // start of its two solves, energy account
inline constexpr double newton_cost = 4.0;   // forces, matrix, line search
inline constexpr double product_cost = 0.2;  // with the matrix, preconditioner included
// The cost of a Verlet step in single precision, in those in double precision: 0.29 to 0.55 on the
// beams W(4) to W(17) and the liver.
inline constexpr double single_step_cost = 0.4;

// Whether implicit steps suit the model: it has no contacts and no limits, which explicit steps
// handle better.
bool suits_implicit(const Model& model);

// A stepper that is ready for the first step.
struct StepperChoice {
  StepperKind kind = StepperKind::verlet;
  std::string reason;  // empty if the options name the stepper
  std::unique_ptr<Stepper> stepper;
  FirstStep first;
  StepMemory memory;
};

// May take trial steps from a copy of the state. Throws the errors of find_stable_step.
StepperChoice choose_stepper(const SteppingOptions& options, const Model& model,
                             const Controls& controls, const State& start);

}  // namespace sinew
