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
// Fitted to frames of the network law on W(4), W(8), W(17) and the liver, of 4 to 7 Verlet steps,
// which they predict within a factor of 1.8 (docs/methods/auto.md). The choice uses counted work
// times these constants instead of wall time, so a scene takes the same stepper on every machine.
inline constexpr double step_cost = 2.0;           // start of its two solves, energy account
inline constexpr double newton_cost = 1.5;         // forces, tangent, line search
inline constexpr double single_newton_cost = 0.6;  // the same with forces in single precision
inline constexpr double product_cost = 0.25;       // with the tangent, preconditioner included
// The cost of a Verlet step in single precision, in those in double precision: 0.12 to 0.35 on
// W(4) to W(17) and the liver.
inline constexpr double single_step_cost = 0.22;

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
