// stepper = "implicit" behind the interface of all steppers.
#include "sinew/solver/implicit.h"
#include "sinew/solver/stepper.h"

namespace sinew {
namespace {

// What dt = "auto" takes at most [s]: a step is stable at any length, but shows nothing of
// oscillations that are faster.
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
    const ImplicitReport step = stepper_.step(h, controls, options_, state);
    StepReport report;
    report.newton = step.newton;
    report.products = step.products;
    report.cuts = step.cuts;
    report.residual = step.residual;
    report.ran_out = step.ran_out;
    report.contacts = step.contacts;
    report.deepest = step.deepest;
    report.friction = step.friction;
    report.limits_met = step.within;
    report.recovered = step.righted;
    return report;
  }

  void prepare(double h, const Controls& controls) override {
    stepper_.prepare(h, controls, options_);
  }
  Workspace& workspace() override { return stepper_.workspace(); }

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
