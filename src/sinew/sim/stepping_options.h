// The options of a simulation's steps: those of a scene, or those of a program.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "sinew/scene/scene.h"
#include "sinew/solver/stepper.h"

namespace sinew {

// Whether steps must keep up with the clock, if the scene leaves the choice of the stepper open.
enum class Pace {
  any,     // no: as the options say
  wanted,  // yes: explicit steps, or implicit ones if those are measured to be too slow
  missed,  // yes, and explicit steps have fallen behind: implicit ones if the model allows them
};

struct SteppingOptions {
  StepperKind stepper = StepperKind::verlet;
  StepperOptions method;
  std::optional<double> dt;                   // [s] of all substeps together; absent: "auto"
  int substeps = 1;                           // the step taken is dt / substeps
  double safety = 0.9;                        // share of the stable step that dt = "auto" takes
  bool allow_unstable = false;                // a given step may be longer than the stable one
  double duration = no_limit;                 // [s]; infinity: no end
  double interval = 1.0 / 30.0;               // between the ends of frames [s]
  bool cuts_later = false;                    // the scene cuts after its start
  std::optional<double> budget;               // wall time of a frame's steps [s]
  Pace pace = Pace::any;                      // `any` unless the scene leaves the steps open
  std::string file;                           // the scene's, for messages
  const std::atomic<bool>* cancel = nullptr;  // see Interrupt::cancel

  double given() const { return *dt / substeps; }  // [s]

  // The length of the first step [s], given the stepper's report.
  double first_length(const FirstStep& first) const;
};

SteppingOptions stepping_options(const Scene& scene);

// Number of frames up to the end; the largest integer if there is no end.
std::int64_t count_frames(double duration, double interval);

// The least number of parts of at most `part` that make up `whole`, at least one. A quotient that
// is above an integer only by rounding counts as that integer. Throws Error(input) for more than
// 2^53.
std::int64_t count_parts(double whole, double part);

}  // namespace sinew
