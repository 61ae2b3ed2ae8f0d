// stepper = "auto": Verlet's short steps or long implicit ones, whichever takes less work for the
// scene as it starts. docs/methods/auto.md.
#pragma once

#include <string>

#include "sinew/model/state.h"
#include "sinew/scene/scene.h"
#include "sinew/solver/implicit.h"

namespace sinew {

// What the parts of an implicit step cost, in steps of Verlet on the same model. Measured with
// sinew_bench (ImplicitStep); counted work times these decides, and not the clock, so that a scene
// takes the same stepper on every machine.
inline constexpr double product_cost = 1.0;  // a Hessian product and what preconditions it
inline constexpr double newton_cost = 17.0;  // the rest of a Newton step: forces, line search

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
Choice choose_stepper(const Scene& scene, const Model& model, const State& start,
                      const Contest& contest, const ImplicitOptions& options,
                      ImplicitStepper& stepper);

}  // namespace sinew
