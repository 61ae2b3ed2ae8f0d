// The one policy that chooses a stepper, and its reason. docs/methods/auto.md.
//
// stepper = "auto" takes the stepper that is less work for this scene: explicit steps as the stable
// step allows, or implicit ones as trial steps of the model itself show. Where steps have to keep
// up with the clock (Pace), explicit steps are taken as long as they do.
#pragma once

#include <memory>
#include <string>

#include "sinew/sim/stepping_options.h"

namespace sinew {

// What the parts of an implicit step cost in steps of Verlet in double precision on the same
// model. Fitted to runs of the network law on W(4), W(8) and the liver; with these, steps of 14 to
// 69 steps of Verlet are told within 30 %. Counted work times these decides, and not the clock, so
// that a scene takes the same stepper on every machine.
inline constexpr double step_cost = 6.0;     // starts of its two solves, energy account
inline constexpr double newton_cost = 4.0;   // forces, matrix, line search
inline constexpr double product_cost = 0.2;  // with the matrix, and what preconditions it
// What a step of Verlet in single precision costs, in those in double: 0.29 to 0.55 on the beams
// W(4) to W(17) and the liver.
inline constexpr double single_step_cost = 0.4;

// Whether implicit steps are at home with the model: no contacts, and no limits after every step,
// which explicit steps know better.
bool suits_implicit(const Model& model);

// A stepper that is ready for its first step.
struct StepperChoice {
  StepperKind kind = StepperKind::verlet;
  std::string reason;  // empty where the options name the stepper
  std::unique_ptr<Stepper> stepper;
  FirstStep first;
  StepMemory memory;
};

// May take trial steps from a copy of the state. Throws what find_stable_step throws.
StepperChoice choose_stepper(const SteppingOptions& options, const Model& model,
                             const Controls& controls, const State& start);

}  // namespace sinew
