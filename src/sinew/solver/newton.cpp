#include "sinew/solver/newton.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sinew/base/parallel.h"
#include "sinew/forces/heat.h"
#include "sinew/forces/terms.h"
#include "sinew/solver/linear_solver.h"

namespace sinew {

void keep_free(const Model& model, Field& f) {
  parallel_for(model.node_count(), [&](Index i) {
    if (model.inverse_mass[uz(i)] == 0.0) f[uz(i)] = Vec3::Zero();
  });
}

namespace {

constexpr int most_products =
    500;  // per direction; a truncated direction is a descent direction too
// A load that no rest state can carry drives the body away. Beyond this many times its size
// Newton's method gives up.
constexpr double reach_in_bodies = 10.0;

// The displacement x - from.
Field displacement(const Objective& objective, const State& state) {
  Field u(state.position);
  add(u, -1.0, *objective.from);
  return u;
}

// out = C u, dashpots and viscosity at objective.lagged, and drag.
Field damping_times(const Objective& objective, const Field& u, ForceEvaluator& forces) {
  Field out(u.size());
  forces.products().damping_times({objective.model, objective.controls, *objective.lagged}, u, out);
  return out;
}

// The rounding error of the forces in equilibrium: a unit in the last place of the positions times
// the resistance of a node, over all nodes [N].
double rounding_force(const Objective& objective, const LinearSolver& linear, const State& state) {
  const Model& model = objective.model;
  double far = 0.0;
  for (const Vec3& x : state.position) far = std::max(far, x.cwiseAbs().maxCoeff());
  const double inertial = parallel_sum(model.node_count(), [&](Index i) {
    const double k = objective.inertia * model.mass[uz(i)];
    return model.inverse_mass[uz(i)] == 0.0 ? 0.0 : k * k;
  });
  const double material = 16.0 * linear.resistance2();
  return std::numeric_limits<double>::epsilon() * far * std::sqrt(inertial + material);
}

// The norm of the carried forces, see minimise(). material: the square of the tets' forces at a
// strain of 1e-5 [N2].
double carried(const Objective& objective, double material, const State& state,
               const Field& nodal_force) {
  const Model& model = objective.model;
  const Field outer = outer_forces(model, objective.controls, state);
  double inertial = 0.0;
  if (objective.inertia > 0.0) {
    inertial = parallel_sum(model.node_count(), [&](Index i) {
      const auto k = uz(i);
      if (model.inverse_mass[k] == 0.0) return 0.0;
      const double factor = objective.inertia * model.mass[k];
      return factor * factor * (state.position[k] - (*objective.inertial)[k]).squaredNorm();
    });
  }
  const double reactions = parallel_sum(model.node_count(), [&](Index i) {
    return model.inverse_mass[uz(i)] == 0.0 ? nodal_force[uz(i)].squaredNorm() : 0.0;
  });
  return std::sqrt(std::max({dot(outer, outer), inertial, reactions, material}));
}

// Moves along p. The full step is taken if the force along p is then a fraction of the one before,
// which costs only the force there (`f` becomes it). Otherwise, and always with `strict`, the step
// is halved until the energy decreases. Near equilibrium, where the change is lost in rounding, the
// force along p must shrink instead. Returns false if neither is reached.
bool line_search(const Objective& objective, const Field& p, bool strict, ForceEvaluator& forces,
                 ObjectiveForce& f, State& state) {
  const Model& model = objective.model;
  const double slope = dot(f.free, p);
  const Field start = state.position;
  add(state.position, 1.0, p);
  ObjectiveForce after = objective_force(objective, state, forces);
  if (!strict && std::abs(dot(after.free, p)) <= 0.5 * slope &&
      dot(after.free, after.free) <= 4.0 * dot(f.free, f.free)) {
    f = std::move(after);
    return true;
  }
  state.position = start;
  const double before = objective_value(objective, state, forces);
  // The rounding error of the forces of network and tets, which cancel at rest.
  const double rounding = 1e-13 * parallel_sum(model.tet_count(), [&](Index t) {
                            return model.tet_modulus[uz(t)] * model.rest_volume[uz(t)];
                          });
  double alpha = 1.0;
  for (int cut = 0; cut < 40; ++cut) {
    state.position = start;
    add(state.position, alpha, p);
    const double now = objective_value(objective, state, forces);
    if (now <= before - 1e-4 * alpha * slope) {
      f = objective_force(objective, state, forces);
      return true;
    }
    if (alpha * slope <= 1e-9 * std::max(std::abs(before), std::abs(now)) + rounding) {
      after = objective_force(objective, state, forces);
      if (std::abs(dot(after.free, p)) <= 0.9 * slope) {
        f = std::move(after);
        return true;
      }
    }
    // The minimum of the parabola through energy and slope at 0 and the energy here, within bounds.
    const double bend = now - before + alpha * slope;
    const double best =
        std::isfinite(bend) && bend > 0.0 ? 0.5 * alpha * alpha * slope / bend : 0.0;
    alpha = std::clamp(best, 0.1 * alpha, 0.5 * alpha);
  }
  state.position = start;
  return false;
}

// The largest distance of nodes before Newton's method gives up.
class Reach {
 public:
  Reach(const Model& model, const State& state) {
    const Vec3 rest = size(model.rest_position);
    const Vec3 now = size(state.position);  // leaves middle_ at the middle of the current positions
    reach_ = reach_in_bodies * std::max(rest.maxCoeff(), now.maxCoeff());
  }
  bool holds(const State& state) const {
    return std::all_of(state.position.begin(), state.position.end(), [&](const Vec3& x) {
      return (x - middle_).cwiseAbs().maxCoeff() <= reach_;
    });
  }

 private:
  Vec3 size(const Field& x) {
    Vec3 low = Vec3::Constant(no_limit);
    Vec3 high = -low;
    for (const Vec3& p : x) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    middle_ = 0.5 * (low + high);
    return high - low;
  }
  Vec3 middle_ = Vec3::Zero();
  double reach_ = 0.0;
};

}  // namespace

double objective_value(const Objective& objective, const State& state, ForceEvaluator& forces) {
  const Model& model = objective.model;
  const std::span<const double> tet_volume = forces.tet_volumes(state.position);
  double e = potential_energy(configuration(model, objective.controls, state), tet_volume);
  if (objective.share != 0.0) {
    e += objective.share * parallel_sum(model.node_count(), [&](Index i) {
           return (*objective.dead_force)[uz(i)].dot(state.position[uz(i)] -
                                                     model.rest_position[uz(i)]);
         });
  }
  if (objective.inertia > 0.0) {
    e += 0.5 * objective.inertia * parallel_sum(model.node_count(), [&](Index i) {
           const auto k = uz(i);
           if (model.inverse_mass[k] == 0.0) return 0.0;
           return model.mass[k] * (state.position[k] - (*objective.inertial)[k]).squaredNorm();
         });
  }
  if (objective.rate > 0.0) {
    const Field u = displacement(objective, state);
    e += 0.5 * objective.rate * damping_power(model, *objective.lagged, u, u);
  }
  if (objective.constraints != nullptr) {
    e += objective.constraints->value(state.position, tet_volume);
  }
  return e;
}

ObjectiveForce objective_force(const Objective& objective, const State& state,
                               ForceEvaluator& forces) {
  const Model& model = objective.model;
  ObjectiveForce found;
  found.nodal_force = forces.evaluate(objective.controls, state).force;
  if (objective.constraints != nullptr) {
    objective.constraints->add_forces(state.position, forces.tets(state.position),
                                      found.nodal_force);
  }
  found.free = found.nodal_force;
  Field& f = found.free;
  if (objective.rate > 0.0)
    add(f, -objective.rate, damping_times(objective, displacement(objective, state), forces));
  if (objective.share != 0.0) add(f, -objective.share, *objective.dead_force);
  if (objective.inertia > 0.0) {
    parallel_for(model.node_count(), [&](Index i) {
      const auto k = uz(i);
      f[k] -= objective.inertia * model.mass[k] * (state.position[k] - (*objective.inertial)[k]);
    });
  }
  keep_free(model, f);
  return found;
}

namespace {

// The steps of minimise(), from the force at the state; `f` becomes the force at the end.
NewtonReport newton_steps(const Objective& objective, LinearSolver& linear,
                          const NewtonOptions& options, ForceEvaluator& forces, State& state,
                          ObjectiveForce& f) {
  NewtonReport report;
  const Reach reach(objective.model, state);
  const double material = 1e-10 * linear.force2();
  const double rounding = rounding_force(objective, linear, state);
  const Clock::time_point start = Clock::now();
  f = objective_force(objective, state, forces);
  Deadline deadline = options.deadline;
  // The line search and the force at its end take about three evaluations like this one.
  if (deadline) *deadline -= 3 * (Clock::now() - start);
  Field p;
  for (;;) {
    report.force = std::sqrt(dot(f.free, f.free));
    const double scale = carried(objective, material, state, f.nodal_force);
    report.residual = report.force == 0.0 ? 0.0 : report.force / scale;
    if (options.on_progress) options.on_progress({report.newton, report.residual});
    if (!(report.force < no_limit) || !reach.holds(state)) return report;
    report.rests = report.force <= std::max(options.tolerance * scale, rounding);
    report.stopped = options.stop != nullptr && options.stop->load();
    if (report.rests || report.stopped || report.newton == options.most) return report;
    report.ran_out = report.newton > 0 && passed(deadline);
    if (report.ran_out) return report;
    const double forcing = std::clamp(std::sqrt(report.residual), 1e-4, 0.3);
    linear.assemble(objective, state.position, state.time, forces);
    report.products += linear.solve(f.free, forcing, most_products, deadline, p, options.stop);
    ++report.newton;
    report.stopped = options.stop != nullptr && options.stop->load();
    if (report.stopped) return report;
    if (!line_search(objective, p, options.deadline.has_value(), forces, f, state)) return report;
  }
}

}  // namespace

NewtonReport minimise(const Objective& objective, LinearSolver& linear,
                      const NewtonOptions& options, ForceEvaluator& forces, State& state) {
  ObjectiveForce f;
  NewtonReport report = newton_steps(objective, linear, options, forces, state, f);
  report.nodal_force = std::move(f.nodal_force);
  return report;
}

}  // namespace sinew
