// How a simulation is stepped: what a scene says of it, or what a program wants instead.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "sinew/scene/scene.h"
#include "sinew/solver/stepper.h"

namespace sinew {

// Whether steps have to keep up with the clock, where the scene leaves the choice of them.
enum class Pace {
  any,     // no: as the options say
  wanted,  // yes: explicit steps, or implicit ones where those are measured to be too slow
  missed,  // yes, and explicit steps have fallen behind: implicit ones where the model allows
};

struct SteppingOptions {
  StepperKind stepper = StepperKind::verlet;
  StepperOptions method;
  std::optional<double> dt;      // [s] of all substeps together; absent: "auto"
  int substeps = 1;              // the step taken is dt / substeps
  double safety = 0.9;           // share of the stable step that dt = "auto" takes
  bool allow_unstable = false;   // a given step may be longer than the stable one
  double duration = no_limit;    // [s]; infinity: it does not end by itself
  double interval = 1.0 / 30.0;  // between the ends of frames [s]
  std::optional<double> budget;  // wall time of a frame's steps [s]
  Pace pace = Pace::any;         // not `any` only where the scene names no steps
  std::string file;              // the scene's, for messages

  double given() const { return *dt / substeps; }  // [s]

  // The length of the first step [s], where the stepper says this of it.
  double first_length(const FirstStep& first) const;
};

SteppingOptions stepping_options(const Scene& scene);

// Frames up to the end; the largest number where there is none.
std::int64_t count_frames(double duration, double interval);

// The least number of parts of at most `part` that make up `whole`, one at least. A quotient that
// rounding has left a little above an integer is that integer.
std::int64_t count_parts(double whole, double part);

}  // namespace sinew
