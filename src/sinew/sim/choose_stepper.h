// stepper = "auto": Verlet's short steps or long implicit ones, whichever takes less work for the
// scene as it starts. docs/methods/auto.md.
#pragma once

#include <string>

#include "sinew/model/controls.h"
#include "sinew/model/state.h"
#include "sinew/scene/scene.h"
#include "sinew/solver/implicit.h"

namespace sinew {

// What the parts of an implicit step cost, in steps of Verlet in double precision on the same
// model. Fitted to runs of the network law on W(4), W(8) and the liver; with these, steps of 14 to
// 69 steps of Verlet are told within 30 %. Counted work times these decides, and not the clock, so
// that a scene takes the same stepper on every machine.
inline constexpr double step_cost = 6.0;     // starts of its two solves, energy account
inline constexpr double newton_cost = 4.0;   // forces, matrix, line search
inline constexpr double product_cost = 0.2;  // with the matrix, and what preconditions it
// What a step of Verlet in single precision costs, in those in double: 0.29 to 0.55 on the beams
// W(4) to W(17) and the liver.
inline constexpr double single_step_cost = 0.4;

struct Choice {
  std::string stepper;  // verlet, implicit
  std::string reason;   // "verlet: stable step ..., ... a frame; implicit: ..."
};

// What the two ways through a frame of `interval` [s] are made of.
struct Contest {
  double interval = 0.0;
  double verlet_step = 0.0;          // [s]
  double stable_step = 0.0;          // [s]
  double implicit_step = 0.0;        // [s]
  const char* projection = nullptr;  // what only Verlet's step knows, if the scene has it
};

// Takes trial steps of `stepper` on a copy of the state.
Choice choose_stepper(const Scene& scene, const Model& model, const Controls& controls,
                      const State& start, const Contest& contest, const ImplicitOptions& options,
                      ImplicitStepper& stepper);

}  // namespace sinew
