// Which method takes the steps, with the words that scenes have for it.
#pragma once

#include <array>

#include "sinew/base/words.h"
#include "sinew/forces/precision.h"

namespace sinew {

enum class StepperKind {
  automatic,  // to be chosen (sim/choose_stepper.h)
  verlet,     // explicit steps (solver/verlet.h)
  implicit,   // implicit steps (solver/implicit.h)
  rest,       // rest states, one a frame (solver/static.h)
};
constexpr std::array<Word<StepperKind>, 4> words_of(StepperKind) {
  return {{{StepperKind::verlet, "verlet"},
           {StepperKind::implicit, "implicit"},
           {StepperKind::rest, "static"},
           {StepperKind::automatic, "auto"}}};
}

// Of implicit steps.
enum class Scheme {
  backward_euler,  // first order, damps every oscillation
  sdirk2           // second order, hardly damps, two solves a step
};
constexpr std::array<Word<Scheme>, 2> words_of(Scheme) {
  return {{{Scheme::sdirk2, "sdirk2"}, {Scheme::backward_euler, "backward-euler"}}};
}

}  // namespace sinew
