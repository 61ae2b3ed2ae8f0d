#include "sinew/solver/static.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sinew/base/error.h"
#include "sinew/base/parallel.h"
#include "sinew/forces/righting.h"
#include "sinew/forces/stiffness.h"
#include "sinew/forces/terms.h"
#include "sinew/forces/volume.h"

namespace sinew {
namespace {

using Field = std::vector<Vec3>;

constexpr double turn_per_load_step = 20.0 * 3.14159265358979 / 180.0;  // [rad]
// A nearly incompressible body comes to rest in a third of the Newton steps when it starts from the
// rest state of one whose kappa is at most this many times mu: W(4) at nu = 0.499 takes 6 + 7
// instead of 21.
constexpr double soft_volume = 30.0;
constexpr int most_cuts = 12;  // a load step may become this often half as long
constexpr int most_products =
    500;  // for one direction; a truncated one leads downhill all the same
// A load that no rest state can carry drives the body away: further than this many times its size,
// Newton's method has lost it.
constexpr double farthest = 10.0;

double dot(const Field& a, const Field& b) {
  return parallel_sum(static_cast<Index>(a.size()),
                      [&](Index i) { return a[uz(i)].dot(b[uz(i)]); });
}

void add(Field& x, double a, const Field& y) {  // x += a y
  parallel_for(static_cast<Index>(x.size()), [&](Index i) { x[uz(i)] += a * y[uz(i)]; });
}

// z = P^-1 r with  P^-1 = A^-1 - A^-1 B^T D B A^-1:  A the scalar Laplacian, B the volumes' rates
// at x, D = (V/kappa + 3 V/mu)^-1. It is the inverse of A + B^T (kappa/V) B with 3 V/mu in the
// place of B A^-1 B^T (Woodbury); because (div u)^2 <= 3 |grad u|^2 that place is filled from
// above, and P^-1 stays positive. Without it the iterations grow as sqrt(kappa/mu).
// Expects what prepare_stiffness leaves in the workspace.
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

void keep_free(const Model& model, Field& f) {
  parallel_for(model.node_count(), [&](Index i) {
    if (model.inverse_mass[uz(i)] == 0.0) f[uz(i)] = Vec3::Zero();
  });
}

// The largest angle [rad] that a pin turns by between two times.
double pins_turn(const Model& model, double from, double to) {
  double largest = 0.0;
  for (const Pin& pin : model.pins) {
    if (pin.path.keys.empty()) continue;
    double angle = 0.0;
    constexpr int samples = 64;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 arm = pin.path.pivot + Vec3::Unit(axis);
      double turned = 0.0;
      const auto at = [&](int s) {
        const double t = from + (to - from) * s / samples;
        return Vec3(pin.path.at(t, arm) - pin.path.at(t, pin.path.pivot));
      };
      for (int s = 0; s < samples; ++s) {
        const Vec3 a = at(s);
        const Vec3 b = at(s + 1);
        turned += std::atan2(a.cross(b).norm(), a.dot(b));
      }
      angle = std::max(angle, turned);
    }
    largest = std::max(largest, angle);
  }
  return largest;
}

// Bodies joined by attachments, as the first body of each group (bodies).
std::vector<std::size_t> joined_bodies(const Model& model) {
  std::vector<std::size_t> group(model.bodies.size());
  std::iota(group.begin(), group.end(), std::size_t{0});
  const auto body_of = [&](Index node) {
    std::size_t b = 0;
    while (b < model.bodies.size() && !model.bodies[b].nodes.contains(node)) ++b;
    return b;
  };
  for (auto s = uz(model.first_attachment); s < model.springs.size(); ++s) {
    const std::size_t a = body_of(model.springs[s][0]);
    const std::size_t b = body_of(model.springs[s][1]);
    if (a == group.size() || b == group.size() || group[a] == group[b]) continue;
    const std::size_t low = std::min(group[a], group[b]);
    const std::size_t high = std::max(group[a], group[b]);
    std::replace(group.begin(), group.end(), high, low);
  }
  return group;
}

// A body that nothing holds rests only under forces that cancel each other.
void refuse_unheld_bodies(const Model& model, const Field& force) {
  const std::vector<std::size_t> group = joined_bodies(model);
  std::vector<char> held(group.size(), 0);
  std::vector<Vec3> net(group.size(), Vec3::Zero());
  std::vector<double> size(group.size(), 0.0);
  for (std::size_t b = 0; b < group.size(); ++b) {
    for (auto i = uz(model.bodies[b].nodes.begin); i < uz(model.bodies[b].nodes.end); ++i) {
      if (model.inverse_mass[i] == 0.0) held[group[b]] = 1;
      net[group[b]] += force[i];
      size[group[b]] += force[i].norm();
    }
  }
  for (auto s = uz(model.first_attachment); s < model.springs.size(); ++s) {
    for (const Index end : model.springs[s]) {
      if (end < model.body_node_count()) continue;  // an anchor holds what the other end belongs to
      const Index other = model.springs[s][0] == end ? model.springs[s][1] : model.springs[s][0];
      for (std::size_t b = 0; b < group.size(); ++b) {
        if (model.bodies[b].nodes.contains(other)) held[group[b]] = 1;
      }
    }
  }
  for (std::size_t b = 0; b < group.size(); ++b) {
    const std::size_t g = group[b];
    if (held[g] == 0 && net[g].norm() > 1e-6 * size[g]) {
      throw Error(ErrorKind::input,
                  fmt::format("body '{}' has no rest state: nothing holds it against {:.4g} N",
                              model.bodies[b].name, net[g].norm()),
                  "pin it, attach it, or take stepper = \"verlet\"");
    }
  }
}

// The pull of a dead force that is gone when the load step is done: it makes the start of the
// solve a rest state, so that the way from there to the goal can be cut into small steps.
struct Homotopy {
  Field force;         // (nodes)
  double share = 0.0;  // 1: the start rests; 0: the goal
};

}  // namespace

struct StaticSolver::Loads {
  const StaticOptions& options;
  StaticReport& report;
  Homotopy homotopy;
  int load_step = 0;
  double load = 0.0;
};

namespace {

// Total force with the homotopy's; fills workspace.force of all nodes, returns that of the free.
Field free_force(const Model& model, const State& state, const Homotopy& homotopy,
                 Workspace& workspace) {
  compute_forces(model, state, workspace);
  Field f = workspace.force;
  keep_free(model, f);
  if (homotopy.share != 0.0) add(f, -homotopy.share, homotopy.force);
  return f;
}

double energy(const Model& model, const State& state, const Homotopy& homotopy,
              Workspace& workspace) {
  double e = potential_energy(model, state, workspace);
  if (homotopy.share != 0.0) {
    e += homotopy.share * parallel_sum(model.node_count(), [&](Index i) {
           return homotopy.force[uz(i)].dot(state.position[uz(i)] - model.rest_position[uz(i)]);
         });
  }
  return e;
}

// |outer forces on the free nodes| or |forces on the pinned nodes|, whichever is larger; where both
// vanish, 1e-5 of what the material pulls with at a strain of one.
double carried(const Model& model, const State& state, const Workspace& workspace) {
  const Field outer = outer_forces(model, state);
  const double reactions = parallel_sum(model.node_count(), [&](Index i) {
    return model.inverse_mass[uz(i)] == 0.0 ? workspace.force[uz(i)].squaredNorm() : 0.0;
  });
  const double material = parallel_sum(model.tet_count(), [&](Index t) {
    const double pull =
        1e-5 * model.tet_modulus[uz(t)] * std::pow(model.rest_volume[uz(t)], 2.0 / 3.0);
    return pull * pull;
  });
  return std::sqrt(std::max({dot(outer, outer), reactions, material}));
}

}  // namespace

StaticSolver::StaticSolver(const Model& model)
    : model_(model), workspace_(model), preconditioner_(model) {
  double stiffest = 0.0;
  for (std::size_t t = 0; t < model.tets.size(); ++t) {
    double bulk = model.tet_bulk[t];
    for (const Index c : model.cells[t]) {
      if (c >= 0) bulk = std::max(bulk, model.cell_bulk[uz(c)]);
    }
    stiffest = std::max(stiffest, bulk / model.tet_modulus[t]);
  }
  if (stiffest <= 2.0 * soft_volume) return;
  softened_ = std::make_unique<Model>(model);
  for (std::size_t t = 0; t < model.tets.size(); ++t) {
    const double most = soft_volume * model.tet_modulus[t];
    softened_->tet_bulk[t] = std::min(softened_->tet_bulk[t], most);
    for (const Index c : model.cells[t]) {
      if (c >= 0) softened_->cell_bulk[uz(c)] = std::min(softened_->cell_bulk[uz(c)], most);
    }
  }
}

int StaticSolver::solve_tangent(const std::vector<Vec3>& x, const std::vector<Vec3>& rhs,
                                double tolerance, std::vector<Vec3>& u) {
  prepare_stiffness(model_, x, workspace_);
  const auto times = [&](const Field& in, Field& out) {
    stiffness_damping_times(model_, x, 1.0, 0.0, in, Tangent::full, workspace_, out);
  };
  Field r(rhs);
  Field q(u.size());
  keep_free(model_, r);
  const double goal = tolerance * std::sqrt(dot(r, r));
  times(u, q);
  add(r, -1.0, q);
  // Nothing but a prescribed displacement: its forces set the scale.
  const double target = goal > 0.0 ? goal : tolerance * std::sqrt(dot(r, r));
  Field z, p;
  precondition(model_, preconditioner_, r, workspace_, z);
  p = z;
  double rz = dot(r, z);
  int products = 1;
  const int most = 20000;
  while (std::sqrt(dot(r, r)) > target && products < most) {
    times(p, q);
    ++products;
    const double curvature = dot(p, q);
    if (!(curvature > 0.0)) break;
    const double alpha = rz / curvature;
    add(u, alpha, p);
    add(r, -alpha, q);
    precondition(model_, preconditioner_, r, workspace_, z);
    const double next = dot(r, z);
    const double beta = next / rz;
    rz = next;
    parallel_for(model_.node_count(), [&](Index i) { p[uz(i)] = z[uz(i)] + beta * p[uz(i)]; });
  }
  return products;
}

namespace {

// An approximate solution p of K p = r: conjugate gradients that stop at |residual| <= forcing |r|
// or where the energy turns out not to be convex (Steihaug 1983).
int newton_direction(const Model& model, const Field& x, const Field& r0, double forcing,
                     const ScalarPreconditioner& preconditioner, Workspace& workspace, Field& p) {
  prepare_stiffness(model, x, workspace);
  p.assign(r0.size(), Vec3::Zero());
  Field r(r0), z, q(r0.size());
  precondition(model, preconditioner, r, workspace, z);
  Field d(z);
  double rz = dot(r, z);
  const double goal = forcing * std::sqrt(dot(r, r));
  int products = 0;
  while (products < most_products) {
    stiffness_damping_times(model, x, 1.0, 0.0, d, Tangent::full, workspace, q);
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
bool line_search(const Model& model, const Field& f, const Field& p, const Homotopy& homotopy,
                 Workspace& workspace, State& state) {
  const double slope = dot(f, p);
  const double before = energy(model, state, homotopy, workspace);
  // What the pull of the network and the push of the tets, which cancel at rest, leave of digits.
  const double rounding = 1e-13 * parallel_sum(model.tet_count(), [&](Index t) {
                            return model.tet_modulus[uz(t)] * model.rest_volume[uz(t)];
                          });
  const Field start = state.position;
  double alpha = 1.0;
  for (int cut = 0; cut < 40; ++cut) {
    state.position = start;
    add(state.position, alpha, p);
    const double now = energy(model, state, homotopy, workspace);
    if (now <= before - 1e-4 * alpha * slope) return true;
    if (alpha * slope <= 1e-9 * std::max(std::abs(before), std::abs(now)) + rounding) {
      const Field after = free_force(model, state, homotopy, workspace);
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

bool has_run_away(const Model& model, const State& state) {
  Vec3 low = Vec3::Constant(no_limit);
  Vec3 high = -low;
  for (const Vec3& X : model.rest_position) {
    low = low.cwiseMin(X);
    high = high.cwiseMax(X);
  }
  for (const Pin& pin : model.pins) {  // what pins carry off has not run away
    for (const Index node : pin.nodes) {
      low = low.cwiseMin(state.position[uz(node)]);
      high = high.cwiseMax(state.position[uz(node)]);
    }
  }
  const double reach = farthest * (high - low).maxCoeff();
  const Vec3 middle = 0.5 * (low + high);
  return std::any_of(state.position.begin(), state.position.end(),
                     [&](const Vec3& x) { return !((x - middle).cwiseAbs().maxCoeff() <= reach); });
}

// Newton's method to rest. Returns false when it does not get there.
template <typename Steps>
bool newton(const Model& model, const ScalarPreconditioner& preconditioner, const Steps& steps,
            double tolerance, Workspace& workspace, State& state) {
  const StaticOptions& options = steps.options;
  StaticReport& report = steps.report;
  Field p;
  for (int k = 0;; ++k) {
    const Field f = free_force(model, state, steps.homotopy, workspace);
    report.force = std::sqrt(dot(f, f));
    const double scale = carried(model, state, workspace);
    report.residual = report.force == 0.0 ? 0.0 : report.force / scale;
    if (options.on_progress) {
      options.on_progress({steps.load_step, steps.load, report.newton, report.residual});
    }
    if (!(report.force < std::numeric_limits<double>::infinity())) return false;
    if (has_run_away(model, state)) return false;
    if (report.force <= tolerance * scale) return true;
    if (options.stop != nullptr && options.stop->load()) {
      report.stopped = true;
      return true;
    }
    if (k == options.max_newton) return false;
    const double forcing = std::clamp(std::sqrt(report.residual), 1e-4, 0.1);
    report.products +=
        newton_direction(model, state.position, f, forcing, preconditioner, workspace, p);
    ++report.newton;
    if (!line_search(model, f, p, steps.homotopy, workspace, state)) return false;
  }
}

}  // namespace

StaticReport StaticSolver::solve(double time, const StaticOptions& options, State& state) {
  StaticReport report;
  const double start_time = state.time;
  std::fill(state.half_velocity.begin(), state.half_velocity.end(), Vec3::Zero());
  state.last_step = 0.0;
  state.time = time;  // of the loads; the pins follow below
  refuse_unheld_bodies(model_, outer_forces(model_, state));
  compute_forces(model_, state, workspace_);
  if (find_tangled(model_, workspace_) > 0) {
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
      if (workspace_.tangled[b] == 0) continue;
      const std::vector<Vec3> shape = rest_shape_at(model_, model_.bodies[b], state.position);
      std::copy(shape.begin(), shape.end(), state.position.begin() + model_.bodies[b].nodes.begin);
    }
    compute_forces(model_, state, workspace_);
  }

  Loads steps{options, report, {workspace_.force, 0.0}, 0, 0.0};
  keep_free(model_, steps.homotopy.force);
  const int turns =
      static_cast<int>(std::ceil(pins_turn(model_, start_time, time) / turn_per_load_step));
  double length = 1.0 / std::max({1, options.min_load_steps, turns});
  bool gradual = options.min_load_steps > 1;  // outer forces too
  int cuts = 0;
  double done = 0.0;
  while (done < 1.0) {
    const double next = done + length > 1.0 - 1e-9 ? 1.0 : done + length;
    const State before = state;
    Field move(state.position.size(), Vec3::Zero());
    for (const Pin& pin : model_.pins) {
      for (const Index node : pin.nodes) {
        const double t = start_time + next * (time - start_time);
        move[uz(node)] = pin.path.at(t, model_.rest_position[uz(node)]) - state.position[uz(node)];
      }
    }
    preconditioner_.extend(move);
    add(state.position, 1.0, move);
    steps.homotopy.share = gradual ? 1.0 - next : 0.0;
    steps.load_step = ++report.load_steps;
    steps.load = next;
    // On the way it is enough to stay near the path.
    const double tolerance = next < 1.0 ? std::max(options.tolerance, 1e-3) : options.tolerance;
    bool rests = true;
    if (softened_) rests = newton(*softened_, preconditioner_, steps, 1e-2, workspace_, state);
    rests = rests && newton(model_, preconditioner_, steps, tolerance, workspace_, state);
    if (rests) {
      done = next;
      if (report.stopped) break;
      if (cuts > 0) {
        --cuts;
        length *= 2.0;
      }
      continue;
    }
    if (++cuts > most_cuts || report.newton > options.most_newton) {
      throw Error(ErrorKind::diverged,
                  fmt::format("no rest state found: after {} Newton steps, at {:.3g} of the load, "
                              "the forces on the free nodes are {:.3g} of what they carry; there "
                              "may be none under the whole load",
                              report.newton, next, report.residual),
                  "make the load smaller, hold the body at more nodes, or take stepper = "
                  "\"verlet\"");
    }
    state = before;
    gradual = true;
    length *= 0.5;
  }
  state.half_velocity.assign(state.position.size(), Vec3::Zero());
  ++state.step;
  return report;
}

}  // namespace sinew
