#include "sinew/solver/stepper.h"

#include "sinew/base/error.h"

namespace sinew {

// One per stepper, each in the file of its steps: verlet_steps.cpp, implicit_steps.cpp ...
std::unique_ptr<Stepper> verlet_steps(const Model& model, const StepperOptions& options);
std::unique_ptr<Stepper> implicit_steps(const Model& model, const StepperOptions& options);
std::unique_ptr<Stepper> rest_steps(const Model& model, const StepperOptions& options);

std::optional<double> Stepper::watch(double, const Controls&, const State&, StepMemory&) {
  return std::nullopt;
}

void Stepper::prepare(double, const Controls&) {}

std::unique_ptr<Stepper> make_stepper(StepperKind kind, const Model& model,
                                      const StepperOptions& options) {
  switch (kind) {
    case StepperKind::verlet:
      return verlet_steps(model, options);
    case StepperKind::implicit:
      return implicit_steps(model, options);
    case StepperKind::rest:
      return rest_steps(model, options);
    case StepperKind::automatic:
      break;
  }
  throw Error(
      ErrorKind::internal,
      "StepperKind::automatic must be resolved by choose_stepper() before a stepper is made");
}

}  // namespace sinew
