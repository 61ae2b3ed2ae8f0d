// stepper = "static": a rest state at the end of every step.
#include "sinew/solver/static.h"
#include "sinew/solver/stepper.h"

namespace sinew {
namespace {

class RestSteps : public Stepper {
 public:
  RestSteps(const Model& model, const StepperOptions& options) : solver_(model) {
    options_.tolerance = options.tolerance;
  }

  FirstStep begin(const Controls&, const State&, StepMemory& memory) override {
    memory = {};
    return {};
  }

  StepReport step(double h, const Controls& controls, const Interrupt& interrupt, State& state,
                  StepMemory&) override {
    options_.stop = interrupt.stop;
    return solver_.solve(controls, state.time + h, options_, state);
  }

  bool finds_rest() const override { return true; }
  ForceEvaluator& forces() override { return solver_.forces(); }

 private:
  StaticSolver solver_;
  StaticOptions options_;
};

}  // namespace

std::unique_ptr<Stepper> rest_steps(const Model& model, const StepperOptions& options);
std::unique_ptr<Stepper> rest_steps(const Model& model, const StepperOptions& options) {
  return std::make_unique<RestSteps>(model, options);
}

}  // namespace sinew
