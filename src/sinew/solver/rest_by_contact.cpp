// Rest states of bodies that contacts with each other or friction hold. docs/methods/static.md.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sinew/base/error.h"
#include "sinew/base/parallel.h"
#include "sinew/forces/terms.h"
#include "sinew/model/mean_edge.h"
#include "sinew/solver/newton.h"
#include "sinew/solver/static.h"

namespace sinew {
namespace {

constexpr double shortest_step = 1e-5;  // [s]
constexpr double longest_step = 100.0;  // [s]
constexpr int most_steps = 1000;
constexpr double reach_in_sizes = 20.0;  // a body that moves this many times its size is not held

Vec3 centre(const Model& model, const Body& body, const Field& x) {
  Vec3 sum = Vec3::Zero();
  double mass = 0.0;
  for (auto i = uz(body.nodes.begin); i < uz(body.nodes.end); ++i) {
    sum += model.mass[i] * x[i];
    mass += model.mass[i];
  }
  return sum / mass;
}

// The first body that has moved further than it would if something held it; none: null.
const Body* find_escaping(const Model& model, const Field& from, const Field& x) {
  for (const Body& body : model.bodies) {
    const double size = std::cbrt(body.rest_volume);
    const double moved = (centre(model, body, x) - centre(model, body, from)).norm();
    if (moved > reach_in_sizes * size) return &body;
  }
  return nullptr;
}

}  // namespace

// Steps of backward Euler that start without velocity, x_(n+1) the minimum of
//   E(x) + |x - x_n|_M^2 / (2 h^2)
// with the contacts on the way from x_n, friction included: every step
// lowers the energy, so the bodies sink onto each other and never pass through (the proximal point
// method, Rockafellar 1976). h grows, until the inertial force M (x_(n+1) - x_n) / h^2, the force
// that is out of balance, is within the tolerance.
NewtonReport StaticSolver::rest_by_contact(const Controls& controls, const StaticOptions& options,
                                           StaticProgress progress, State& state) {
  const Field start = state.position;
  const Field outer = outer_forces(model_, controls, state);
  double load = std::sqrt(dot(outer, outer));  // [N]
  double mass2 = 0.0;
  for (std::size_t i = 0; i < start.size(); ++i)
    if (model_.inverse_mass[i] > 0.0) mass2 += model_.mass[i] * model_.mass[i];
  // A free fall of a fifth of an edge in the first step.
  const double fall = load > 0.0 ? load / std::sqrt(mass2) : 1.0;  // [m/s2]
  double h = std::sqrt(0.2 * mean_edge(model_) / fall);
  double residual = 1.0;
  NewtonReport report;
  report.residual = 1.0;
  std::unique_ptr<Constraints> constraints;
  const double most_products = options.most_work / static_cast<double>(model_.node_count());
  for (int step = 0; step < most_steps && h > shortest_step && report.products < most_products;
       ++step) {
    const State before = state;
    const double inertia = 1.0 / (h * h);
    if (!constraints) constraints = std::make_unique<Constraints>(model_, inertia, 1.0 / h, true);
    constraints->start(controls, state, &before.position, 0.0);
    Objective objective{model_, controls};
    objective.inertia = inertia;
    objective.inertial = &before.position;
    objective.constraints = constraints.get();
    const double tolerance = std::clamp(0.1 * residual, options.tolerance, 1e-3);
    const NewtonReport once = minimise_augmented_lagrangian(
        objective, linear_, {tolerance, options.max_newton, options.stop, {}}, forces_, state);
    report.newton += once.newton;
    report.products += once.products;
    report.stopped = once.stopped;
    if (once.stopped) return report;
    if (!once.rests || !once.within) {
      state = before;
      h *= 0.3;
      constraints.reset();
      continue;
    }
    constraints->store(state);
    report.nodal_force = once.nodal_force;
    report.within = once.within;
    const double force = std::sqrt(parallel_sum(model_.node_count(), [&](Index i) {
      const auto n = uz(i);
      if (model_.inverse_mass[n] == 0.0) return 0.0;
      const double k = inertia * model_.mass[n];
      return k * k * (state.position[n] - before.position[n]).squaredNorm();
    }));
    if (load == 0.0) load = std::max(force, 1e-300);  // only pins or obstacles have moved
    residual = force / load;
    report.force = force;
    report.residual = residual;
    progress.newton += once.newton;
    progress.residual = residual;
    if (options.on_progress) options.on_progress(progress);
    if (residual <= options.tolerance) {
      report.rests = true;
      contacts_at_rest_ = constraints->contacts();
      return report;
    }
    if (const Body* body = find_escaping(model_, start, state.position)) {
      throw Error(
          ErrorKind::input,
          fmt::format("body '{}' has no rest state: nothing holds it, it moves away", body->name),
          "pin it, attach it, put it on something, or take stepper = \"verlet\" or "
          "\"implicit\"");
    }
    if (once.newton < 30 && h < longest_step) {
      h *= 2.0;
      constraints.reset();
    }
  }
  report.rests = false;
  return report;
}

}  // namespace sinew
