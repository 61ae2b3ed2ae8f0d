// stepper = "implicit" with the interface of all steppers.
#include "sinew/solver/implicit.h"
#include "sinew/solver/stepper.h"

namespace sinew {
namespace {

// The longest step of dt = "auto" [s]: a step is stable at any length, but does not resolve faster
// oscillations.
constexpr double longest_implicit = 1.0 / 60.0;

class ImplicitSteps : public Stepper {
 public:
  ImplicitSteps(const Model& model, const StepperOptions& options) : stepper_(model) {
    options_.scheme = options.scheme;
    options_.tolerance = options.tolerance;
    options_.single = options.precision == Precision::single;
  }

  FirstStep begin(const Controls&, const State&, StepMemory& memory) override {
    memory = {};
    return {no_limit, longest_implicit, {}};
  }

  StepReport step(double h, const Controls& controls, const Interrupt& interrupt, State& state,
                  StepMemory&) override {
    options_.deadline = interrupt.deadline;
    options_.stop = interrupt.cancel;
    options_.most_cuts = interrupt.trial ? 2 : ImplicitOptions().most_cuts;
    return stepper_.step(h, controls, options_, state);
  }

  void prepare(double h, const Controls& controls) override {
    stepper_.prepare(h, controls, options_);
  }
  ForceEvaluator& forces() override { return stepper_.forces(); }

 private:
  ImplicitStepper stepper_;
  ImplicitOptions options_;
};

}  // namespace

std::unique_ptr<Stepper> implicit_steps(const Model& model, const StepperOptions& options);
std::unique_ptr<Stepper> implicit_steps(const Model& model, const StepperOptions& options) {
  return std::make_unique<ImplicitSteps>(model, options);
}

}  // namespace sinew
