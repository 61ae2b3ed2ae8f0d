// The outer loop of the augmented Lagrangian. docs/methods/constraints.md.
#include <algorithm>

#include "sinew/solver/newton.h"

namespace sinew {
namespace {

constexpr int most_passes = 30;
// While the multipliers are still being found it is enough to come this close [-].
constexpr double on_the_way = 1e-2;
// A pass that leaves more than this share of the error calls for stiffer conditions.
constexpr double slow = 0.5;
constexpr double stiffer = 4.0;

}  // namespace

NewtonReport minimise_within(const Objective& objective, const ScalarPreconditioner& preconditioner,
                             const NewtonOptions& options, Workspace& workspace, State& state) {
  if (objective.constraints == nullptr) {
    return minimise(objective, preconditioner, options, workspace, state);
  }
  NewtonReport report;
  double error = no_limit;  // of the pass before, over what is good enough
  for (int pass = 0; pass < most_passes; ++pass) {
    NewtonOptions o = options;
    if (error > 1.0) o.tolerance = std::max(o.tolerance, on_the_way);
    const NewtonReport of_pass = minimise(objective, preconditioner, o, workspace, state);
    report.newton += of_pass.newton;
    report.products += of_pass.products;
    report.force = of_pass.force;
    report.residual = of_pass.residual;
    report.rests = of_pass.rests && o.tolerance == options.tolerance;
    report.stopped = of_pass.stopped;
    const double now = objective.constraints->update(state.position, workspace);
    report.within = now <= 1.0;
    if (!of_pass.rests || of_pass.stopped || (report.rests && report.within)) return report;
    if (now > 1.0 && now > slow * error) objective.constraints->harden(stiffer);
    error = now;
  }
  return report;
}

}  // namespace sinew
