// The time stepping methods and their names in scenes.
#pragma once

#include <array>

#include "sinew/base/words.h"
#include "sinew/forces/precision.h"

namespace sinew {

enum class StepperKind {
  automatic,  // chosen later (sim/choose_stepper.h)
  verlet,     // explicit steps (solver/verlet.h)
  implicit,   // implicit steps (solver/implicit.h)
  rest,       // rest states, one per frame (solver/static.h)
};
constexpr std::array<Word<StepperKind>, 4> words_of(StepperKind) {
  return {{{StepperKind::verlet, "verlet"},
           {StepperKind::implicit, "implicit"},
           {StepperKind::rest, "static"},
           {StepperKind::automatic, "auto"}}};
}

// The scheme of implicit steps.
enum class Scheme {
  tr_bdf2,         // second order, hardly damps swings and turning, two solves per step
  sdirk2,          // second order, hardly damps swings, two solves per step
  backward_euler,  // first order, damps every oscillation
};
constexpr std::array<Word<Scheme>, 3> words_of(Scheme) {
  return {{{Scheme::tr_bdf2, "tr-bdf2"},
           {Scheme::sdirk2, "sdirk2"},
           {Scheme::backward_euler, "backward-euler"}}};
}

}  // namespace sinew
