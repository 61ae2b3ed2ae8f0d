// Dynamic relaxation: finds rest states that Newton's method does not find from its start.
// docs/methods/static.md.
#include <algorithm>
#include <cmath>

#include "sinew/base/parallel.h"
#include "sinew/forces/terms.h"
#include "sinew/solver/newton.h"
#include "sinew/solver/static.h"

namespace sinew {

// Follows the damped motion of the body to rest: steps of backward Euler, of a length at which
// Newton's method needs few iterations. The velocities are set to zero whenever the kinetic energy
// has passed a maximum (kinetic damping, Cundall 1976). This succeeds if a stiff part has to rotate
// far and Newton's straight steps fail. The whole load acts at once.
NewtonReport StaticSolver::relax_dynamically(const Controls& controls, double start_time,
                                             double time, const StaticOptions& options,
                                             StaticProgress progress, State& state) {
  constexpr int few = 10;        // Newton steps
  constexpr double near = 1e-4;  // Newton's method is tried below this share of the load
  double h = 1.0 / 30.0;         // [s]
  double residual = 1.0;         // the force that still moves the body, as a share of the load
  double fastest = 0.0;          // |v|^2
  const Field outer = outer_forces(model_, controls, state);
  double load = std::sqrt(dot(outer, outer));  // [N]
  NewtonReport report;
  report.products = move_pins_to(controls, start_time, time, 1.0, state);
  Field velocity(state.position.size(), Vec3::Zero());
  Field inertial;
  const auto stop_motion = [&] {
    std::fill(velocity.begin(), velocity.end(), Vec3::Zero());
    fastest = 0.0;
  };
  const double most_products = options.most_work / static_cast<double>(model_.node_count());
  while (h > 1e-6 && report.newton <= 10 * options.most_newton && report.products < most_products) {
    const State before = state;
    inertial = before.position;
    add(inertial, h, velocity);
    Objective objective{model_, controls};
    objective.inertia = 1.0 / (h * h);
    objective.inertial = &inertial;
    if (!constraints_.empty()) objective.constraints = &constraints_;
    constraints_.start(controls, state, nullptr, 0.0);
    state.position = inertial;
    const double tolerance = std::clamp(0.1 * residual, options.tolerance, 1e-3);
    const NewtonReport step = minimise_augmented_lagrangian(
        objective, linear_, {tolerance, 3 * few, options.stop, {}}, forces_, state);
    report.newton += step.newton;
    report.products += step.products;
    report.stopped = step.stopped;
    if (step.stopped) return report;
    if (!step.rests) {
      state = before;
      stop_motion();
      h *= 0.5;
      continue;
    }
    const double force = parallel_sum(model_.node_count(), [&](Index i) {
      velocity[uz(i)] = (state.position[uz(i)] - before.position[uz(i)]) / h;
      if (model_.inverse_mass[uz(i)] == 0.0) velocity[uz(i)].setZero();
      const double k = objective.inertia * model_.mass[uz(i)];
      return k * k * (state.position[uz(i)] - inertial[uz(i)]).squaredNorm();
    });
    if (load == 0.0) load = std::max(std::sqrt(force), 1e-300);  // only pins have moved
    residual = std::sqrt(force) / load;
    progress.newton += step.newton;
    progress.residual = residual;
    if (options.on_progress) options.on_progress(progress);
    if (step.newton < few) h *= 1.2;
    const double speed = dot(velocity, velocity);
    if (speed >= fastest) {
      fastest = speed;
      continue;
    }
    stop_motion();
    if (residual > near) continue;
    const State here = state;
    const NewtonReport rest =
        settle({model_, controls}, {options.tolerance, options.max_newton, options.stop, {}},
               forces_, state);
    report.newton += rest.newton;
    report.products += rest.products;
    if (rest.rests || rest.stopped) {
      const NewtonReport before_it = report;
      report = rest;
      report.newton = before_it.newton;
      report.products = before_it.products;
      return report;
    }
    state = here;
  }
  report.rests = false;
  return report;
}

}  // namespace sinew
