#include "sinew/solver/newton.h"

#include <algorithm>
#include <cmath>

#include "sinew/base/parallel.h"
#include "sinew/forces/spring_law.h"
#include "sinew/forces/stiffness.h"
#include "sinew/forces/terms.h"
#include "sinew/forces/volume.h"

namespace sinew {

double dot(const Field& a, const Field& b) {
  return parallel_sum(static_cast<Index>(a.size()),
                      [&](Index i) { return a[uz(i)].dot(b[uz(i)]); });
}

void add(Field& x, double a, const Field& y) {
  parallel_for(static_cast<Index>(x.size()), [&](Index i) { x[uz(i)] += a * y[uz(i)]; });
}

void keep_free(const Model& model, Field& f) {
  parallel_for(model.node_count(), [&](Index i) {
    if (model.inverse_mass[uz(i)] == 0.0) f[uz(i)] = Vec3::Zero();
  });
}

double damping_power(const Model& model, const Field& x, const Field& v) {
  double sum = parallel_sum(model.node_count(), [&](Index i) {
    const auto k = uz(i);
    return model.inverse_mass[k] == 0.0 ? 0.0 : model.drag[k] * model.mass[k] * v[k].squaredNorm();
  });
  for (const Range& active : model.active_springs) {
    sum += parallel_sum(active.size(), [&](Index i) {
      const auto s = uz(active.begin + i);
      const auto a = uz(model.springs[s][0]);
      const auto b = uz(model.springs[s][1]);
      const Vec3 v_ij = v[b] - v[a];
      return v_ij.dot(dashpot_times(x[b] - x[a], model.damping[s], v_ij));
    });
  }
  return sum;
}

void precondition(const Model& model, const ScalarPreconditioner& laplacian, const Field& r,
                  Workspace& workspace, Field& z) {
  laplacian.apply(r, z);
  if (!model.has_volume) return;
  relax_volume(model, z, workspace);
  Field y(r.size());
  parallel_for(model.node_count(), [&](Index i) {
    y[uz(i)] = press_tets(model, workspace, workspace.tet_pressure_change, i);
  });
  Field correction;
  laplacian.apply(y, correction);
  parallel_for(model.node_count(), [&](Index i) { z[uz(i)] -= correction[uz(i)]; });
}

namespace {

constexpr int most_products =
    500;  // for one direction; a truncated one leads downhill all the same
// A load that no rest state can carry drives the body away: further than this many times its size,
// Newton's method has lost it.
constexpr double farthest = 10.0;

// x - from.
Field way(const Objective& objective, const State& state) {
  Field u(state.position);
  add(u, -1.0, *objective.from);
  return u;
}

// out = C u, dashpots in their directions at objective.lag, and drag.
void damping_times(const Objective& objective, const Field& u, Workspace& workspace, Field& out) {
  out.resize(u.size());
  stiffness_damping_times(objective.model, *objective.lag, 0.0, 1.0, u, Tangent::full, workspace,
                          out);
}

// out = H d at positions x; expects prepare_stiffness.
void hessian_times(const Objective& objective, const Field& x, const Field& d, Workspace& workspace,
                   Field& out) {
  const Model& model = objective.model;
  stiffness_damping_times(model, x, 1.0, 0.0, d, Tangent::full, workspace, out);
  if (objective.inertia > 0.0) {
    parallel_for(model.node_count(), [&](Index i) {
      const auto k = uz(i);
      if (model.inverse_mass[k] > 0.0) out[k] += objective.inertia * model.mass[k] * d[k];
    });
  }
  if (objective.rate > 0.0) {
    Field damped;
    damping_times(objective, d, workspace, damped);
    add(out, objective.rate, damped);
  }
  if (objective.constraints != nullptr) {
    objective.constraints->add_stiffness_times(d, workspace, out);
  }
}

// See minimise().
double carried(const Objective& objective, const State& state, const Workspace& workspace) {
  const Model& model = objective.model;
  const Field outer = outer_forces(model, state);
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
    return model.inverse_mass[uz(i)] == 0.0 ? workspace.force[uz(i)].squaredNorm() : 0.0;
  });
  const double material = parallel_sum(model.tet_count(), [&](Index t) {
    const double pull =
        1e-5 * model.tet_modulus[uz(t)] * std::pow(model.rest_volume[uz(t)], 2.0 / 3.0);
    return pull * pull;
  });
  return std::sqrt(std::max({dot(outer, outer), inertial, reactions, material}));
}

// An approximate solution p of K p = r: conjugate gradients that stop at |residual| <= forcing |r|
// or where the energy turns out not to be convex (Steihaug 1983).
int newton_direction(const Objective& objective, const Field& x, const Field& r0, double forcing,
                     const ScalarPreconditioner& preconditioner, Workspace& workspace, Field& p) {
  const Model& model = objective.model;
  prepare_stiffness(model, x, workspace);
  if (objective.constraints != nullptr) objective.constraints->linearise(x, workspace);
  p.assign(r0.size(), Vec3::Zero());
  Field r(r0), z, q(r0.size());
  precondition(model, preconditioner, r, workspace, z);
  Field d(z);
  double rz = dot(r, z);
  const double goal = forcing * std::sqrt(dot(r, r));
  int products = 0;
  while (products < most_products) {
    hessian_times(objective, x, d, workspace, q);
    ++products;
    const double curvature = dot(d, q);
    if (curvature <= 1e-12 * rz) {
      if (products == 1) p = d;
      break;
    }
    const double alpha = rz / curvature;
    add(p, alpha, d);
    add(r, -alpha, q);
    if (std::sqrt(dot(r, r)) <= goal) break;
    precondition(model, preconditioner, r, workspace, z);
    const double next = dot(r, z);
    const double beta = next / rz;
    rz = next;
    parallel_for(model.node_count(), [&](Index i) { d[uz(i)] = z[uz(i)] + beta * d[uz(i)]; });
  }
  return products;
}

// Moves along p so that the energy falls: halves the step until it does. Close to rest, where the
// change drowns in rounding, the force along p has to shrink instead. Returns false if nothing did.
bool line_search(const Objective& objective, const Field& f, const Field& p, Workspace& workspace,
                 State& state) {
  const Model& model = objective.model;
  const double slope = dot(f, p);
  const double before = objective_value(objective, state, workspace);
  // What the pull of the network and the push of the tets, which cancel at rest, leave of digits.
  const double rounding = 1e-13 * parallel_sum(model.tet_count(), [&](Index t) {
                            return model.tet_modulus[uz(t)] * model.rest_volume[uz(t)];
                          });
  const Field start = state.position;
  double alpha = 1.0;
  for (int cut = 0; cut < 40; ++cut) {
    state.position = start;
    add(state.position, alpha, p);
    const double now = objective_value(objective, state, workspace);
    if (now <= before - 1e-4 * alpha * slope) return true;
    if (alpha * slope <= 1e-9 * std::max(std::abs(before), std::abs(now)) + rounding) {
      const Field after = objective_force(objective, state, workspace);
      if (std::abs(dot(after, p)) <= 0.9 * slope) return true;
    }
    // The parabola through energy and slope at 0 and the energy here, kept in bounds.
    const double bend = now - before + alpha * slope;
    const double best =
        std::isfinite(bend) && bend > 0.0 ? 0.5 * alpha * alpha * slope / bend : 0.0;
    alpha = std::clamp(best, 0.1 * alpha, 0.5 * alpha);
  }
  state.position = start;
  return false;
}

// How far nodes may go before Newton's method has lost them.
class Reach {
 public:
  Reach(const Model& model, const State& state) {
    const Vec3 rest = size(model.rest_position);
    const Vec3 now = size(state.position);  // leaves middle_ where the nodes are
    reach_ = farthest * std::max(rest.maxCoeff(), now.maxCoeff());
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

double objective_value(const Objective& objective, const State& state, Workspace& workspace) {
  const Model& model = objective.model;
  double e = potential_energy(model, state, workspace);
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
    e += 0.5 * objective.rate * damping_power(model, *objective.lag, way(objective, state));
  }
  if (objective.constraints != nullptr) {
    e += objective.constraints->value(state.position, workspace);
  }
  return e;
}

Field objective_force(const Objective& objective, const State& state, Workspace& workspace) {
  const Model& model = objective.model;
  compute_forces(model, state, workspace);
  if (objective.constraints != nullptr) {
    objective.constraints->add_forces(state.position, workspace, workspace.force);
  }
  Field f = workspace.force;
  if (objective.rate > 0.0) {
    Field damped;
    damping_times(objective, way(objective, state), workspace, damped);
    add(f, -objective.rate, damped);
  }
  if (objective.share != 0.0) add(f, -objective.share, *objective.dead_force);
  if (objective.inertia > 0.0) {
    parallel_for(model.node_count(), [&](Index i) {
      const auto k = uz(i);
      f[k] -= objective.inertia * model.mass[k] * (state.position[k] - (*objective.inertial)[k]);
    });
  }
  keep_free(model, f);
  return f;
}

NewtonReport minimise(const Objective& objective, const ScalarPreconditioner& preconditioner,
                      const NewtonOptions& options, Workspace& workspace, State& state) {
  NewtonReport report;
  const Reach reach(objective.model, state);
  Field p;
  for (;;) {
    const Field f = objective_force(objective, state, workspace);
    report.force = std::sqrt(dot(f, f));
    const double scale = carried(objective, state, workspace);
    report.residual = report.force == 0.0 ? 0.0 : report.force / scale;
    if (options.on_progress) options.on_progress({report.newton, report.residual});
    if (!(report.force < no_limit) || !reach.holds(state)) return report;
    report.rests = report.force <= options.tolerance * scale;
    report.stopped = options.stop != nullptr && options.stop->load();
    if (report.rests || report.stopped || report.newton == options.most) return report;
    const double forcing = std::clamp(std::sqrt(report.residual), 1e-4, 0.1);
    report.products +=
        newton_direction(objective, state.position, f, forcing, preconditioner, workspace, p);
    ++report.newton;
    if (!line_search(objective, f, p, workspace, state)) return report;
  }
}

}  // namespace sinew
