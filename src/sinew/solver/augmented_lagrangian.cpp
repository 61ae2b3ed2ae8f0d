// The outer loop of the augmented Lagrangian. docs/methods/constraints.md.
#include <algorithm>
#include <cmath>
#include <utility>

#include "sinew/solver/newton.h"

namespace sinew {
namespace {

constexpr int most_passes = 30;
// The tolerance of the first pass while the multipliers are still wrong; that of every later pass
// is a tenth of the one before [-].
constexpr double first_tolerance = 1e-2;
// If a pass leaves more than this share of the error, the constraints become stiffer.
constexpr double slow = 0.5;
constexpr double stiffer = 4.0;

}  // namespace

NewtonReport minimise_augmented_lagrangian(const Objective& objective, LinearSolver& linear,
                                           const NewtonOptions& options, ForceEvaluator& forces,
                                           State& state) {
  if (objective.constraints == nullptr) {
    return minimise(objective, linear, options, forces, state);
  }
  NewtonReport report;
  report.within = false;
  double distance = no_limit;  // error of the pass before
  for (int pass = 0; pass < most_passes; ++pass) {
    NewtonOptions o = options;
    if (!report.within) o.tolerance = std::max(o.tolerance, first_tolerance * std::pow(0.1, pass));
    NewtonReport of_pass = minimise(objective, linear, o, forces, state);
    report.newton += of_pass.newton;
    report.products += of_pass.products;
    report.force = of_pass.force;
    report.residual = of_pass.residual;
    report.rests = of_pass.rests && o.tolerance == options.tolerance;
    report.stopped = of_pass.stopped;
    report.nodal_force = std::move(of_pass.nodal_force);
    const ConstraintError error = objective.constraints->update(objective.controls, state.position,
                                                                forces.tet_volumes(state.position));
    report.within = error.distance <= 1.0 && error.friction <= 1.0 && error.changed_contacts <= 1.0;
    if (!of_pass.rests || of_pass.stopped || (report.rests && report.within)) return report;
    if (error.distance > std::max(1.0, slow * distance)) objective.constraints->harden(stiffer);
    distance = error.distance;
  }
  return report;
}

}  // namespace sinew
