#include "sinew/solver/static.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sinew/base/error.h"
#include "sinew/base/parallel.h"
#include "sinew/contact/contact_finder.h"
#include "sinew/forces/inversion_recovery.h"
#include "sinew/forces/stiffness.h"
#include "sinew/forces/terms.h"
#include "sinew/model/mean_edge.h"
#include "sinew/solver/implicit.h"
#include "sinew/solver/limit_load.h"
#include "sinew/solver/newton.h"
#include "sinew/solver/support.h"

namespace sinew {
namespace {

constexpr double turn_per_load_step = 20.0 * 3.14159265358979 / 180.0;  // [rad]
// A nearly incompressible body comes to rest in fewer Newton steps from the rest state of a body
// whose kappa is at most this many times mu: W(4) at nu = 0.499 takes 41 instead of 74 at 15 kPa,
// 19 instead of 23 at 1.5 MPa.
constexpr double soft_volume = 30.0;
// Down to this residual the forces of single precision are exact enough, and several times as fast.
constexpr double single_residual = 1e-3;
constexpr int cuts_before_falling = 2;       // then dynamic relaxation is tried, once
constexpr double shortest_load_step = 0.02;  // of the change of the loads
constexpr double share_of_steps = 0.3;  // of StaticOptions::most_work; dynamic relaxation takes all

// The largest rotation angle [rad] of a pin between two times.
double pins_turn(const Controls& controls, double from, double to) {
  double largest = 0.0;
  for (const Path& path : controls.pin_paths) {
    if (path.keys.empty()) continue;
    double angle = 0.0;
    constexpr int samples = 64;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 arm = path.pivot + Vec3::Unit(axis);
      double turned = 0.0;
      const auto at = [&](int s) {
        const double t = from + (to - from) * s / samples;
        return Vec3(path.at(t, arm) - path.at(t, path.pivot));
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

}  // namespace

StaticSolver::StaticSolver(const Model& model)
    : model_(model),
      layout_(std::make_shared<PackedLayout>(model)),
      forces_(model, Precision::double_),
      linear_(model, layout_),
      constraints_(model, 10.0 * model.start_gravity.norm() / mean_edge(model), 0.0, false) {
  if (may_take_single(model, single_residual))
    in_single_.emplace(model, Precision::single, layout_);
  double stiffest = 0.0;
  for (std::size_t t = 0; t < model.tets.size(); ++t) {
    double bulk = model.tet_bulk[t];
    for (const Index c : model.cells[t]) {
      if (c >= 0) bulk = std::max(bulk, model.cell_bulk[uz(c)]);
    }
    stiffest = std::max(stiffest, bulk / model.tet_modulus[t]);
  }
  if (stiffest <= 2.0 * soft_volume) return;
  softened_.reset(new Softened{model});
  Model& soft = softened_->model;
  for (std::size_t t = 0; t < model.tets.size(); ++t) {
    const double most = soft_volume * model.tet_modulus[t];
    soft.tet_bulk[t] = std::min(soft.tet_bulk[t], most);
    for (const Index c : model.cells[t]) {
      if (c >= 0) soft.cell_bulk[uz(c)] = std::min(soft.cell_bulk[uz(c)], most);
    }
  }
}

int StaticSolver::solve_tangent(const Configuration& at, const Field& rhs, double tolerance,
                                Field& u) {
  double each = 1e-4;  // relative reduction by one solve in single precision
  constexpr int most = 20000;
  Field r, p, q(u.size());
  double goal = 0.0;
  double before = no_limit;
  int products = 0;
  const Field x(at.x.begin(), at.x.end());
  const TetState& tets = forces_.tets(x);
  linear_.assemble(Objective{model_, at.controls}, x, at.time, forces_);
  while (products < most) {
    forces_.products().times(at, tets, 1.0, 0.0, u, Tangent::full, q);
    ++products;
    r = rhs;
    keep_free(model_, r);
    if (goal == 0.0) goal = tolerance * std::sqrt(dot(r, r));
    add(r, -1.0, q);
    const double left = std::sqrt(dot(r, r));
    // Only a prescribed displacement acts: its forces set the scale.
    if (goal == 0.0) goal = tolerance * left;
    if (left <= goal) break;
    if (left > 0.5 * before) {  // one solve went too far: goes back and takes shorter ones
      if (each > 0.01) break;
      each *= 30.0;
      add(u, -1.0, p);
      before = no_limit;
      continue;
    }
    before = left;
    products += linear_.solve(r, std::max(each, 0.5 * goal / left), most, {}, p);
    add(u, 1.0, p);
  }
  return products;
}

// Minimises. Nothing holds a body that rests on a plane along the plane and about its normal, and
// nothing at all a free one. A weak spring from every node to its start position holds it, sigma m
// / 2 |x - x_start|^2. The start positions move with the body until the springs carry nothing (the
// proximal point method, Rockafellar 1976).
NewtonReport StaticSolver::settle(Objective objective, const NewtonOptions& options,
                                  ForceEvaluator& forces, State& state) {
  constraints_.start(objective.controls, state, nullptr, 0.0);
  if (!constraints_.empty()) objective.constraints = &constraints_;
  objective.inertia = proximal_stiffness_;
  const Field outer = outer_forces(model_, objective.controls, state);
  const double goal = options.tolerance * std::sqrt(dot(outer, outer));
  NewtonReport report;
  for (;;) {
    const Field start = state.position;
    if (proximal_stiffness_ > 0.0) objective.inertial = &start;
    const NewtonReport once =
        minimise_augmented_lagrangian(objective, linear_, options, forces, state);
    constraints_.store(state);
    constraints_.start(objective.controls, state, nullptr, 0.0);
    const int newton = report.newton + once.newton;
    const int products = report.products + once.products;
    report = once;
    report.newton = newton;
    report.products = products;
    const double force2 = parallel_sum(model_.node_count(), [&](Index i) {
      const double k = proximal_stiffness_ * model_.mass[uz(i)];
      return k * k * (state.position[uz(i)] - start[uz(i)]).squaredNorm();
    });
    if (!once.rests || once.stopped || std::sqrt(force2) <= goal) return report;
    report.rests = newton < 10 * options.most;
    if (!report.rests) return report;
  }
}

// Moves the pins to their positions at this share of the time between two times; the free nodes
// follow by the tangent. Returns the number of Hessian products.
int StaticSolver::move_pins_to(const Controls& controls, double start_time, double time,
                               double share, State& state) {
  Field move(state.position.size(), Vec3::Zero());
  for (std::size_t p = 0; p < model_.pins.size(); ++p) {
    for (const Index node : model_.pins[p].nodes) {
      const double t = start_time + share * (time - start_time);
      move[uz(node)] =
          controls.pin_paths[p].at(t, model_.rest_position[uz(node)]) - state.position[uz(node)];
    }
  }
  int products = 0;
  if (dot(move, move) > 0.0) {
    products = solve_tangent(configuration(model_, controls, state),
                             Field(move.size(), Vec3::Zero()), 1e-2, move);
  }
  add(state.position, 1.0, move);
  return products;
}

void StaticSolver::throw_no_rest(const Controls& controls, double time,
                                 const StaticOptions& options, const State& start,
                                 const StepReport& report) const {
  const Field loads = outer_forces(model_, controls, start);
  if (dot(loads, loads) == 0.0)  // only pins move: no load has a limit
    throw Error(
        ErrorKind::diverged,
        fmt::format("no rest state: {} Newton steps towards the pins at {:.4g} s were taken; at "
                    "the last one the forces on the free nodes were {:.2g} of what they carry",
                    report.newton, time, report.residual),
        softened_
            ? "the bulk modulus is far above the shear modulus: take poisson = 0.499 or less; "
              "or a larger output.fps, or stepper = \"verlet\""
            : "let the pins move less from frame to frame (a larger output.fps), or take "
              "stepper = \"verlet\" to see the motion");
  std::string found;
  const LimitLoad limit = options.finds_limit_load
                              ? find_limit_load(model_, controls, time, options, start)
                              : LimitLoad{};
  if (limit.rests > 0.0 || limit.fails < 1.0) {  // else stopped before the first trial has ended
    found =
        limit.rests > 0.0
            ? fmt::format(
                  "short trials found one under {:.2g} of the loads and "
                  "none under {:.2g}",
                  limit.rests, limit.fails)
            : fmt::format("short trials found none even under {:.2g} of the loads", limit.fails);
    found += " (gravity, forces and pressures; pins move as given). ";
  }
  throw Error(ErrorKind::diverged,
              fmt::format("no rest state: {}{} Newton steps were taken; at the last one the forces "
                          "on the free nodes were {:.2g} of what they carry",
                          found, report.newton, report.residual),
              "make the load smaller or the material stiffer: a load above the limit has no rest "
              "state; or take stepper = \"verlet\" to see the motion");
}

StepReport StaticSolver::settle_by_contact(const Controls& controls, const StaticOptions& options,
                                           const State& start, StepReport report, State& state) {
  ++report.load_steps;
  const NewtonReport found =
      rest_by_contact(controls, options, {report.load_steps, 1.0, 0, 0.0}, state);
  report.newton += found.newton;
  report.products += found.products;
  report.residual = found.residual;
  report.limits_met = found.within;
  report.stopped = found.stopped;
  if (!found.rests && !found.stopped) throw_no_rest(controls, state.time, options, start, report);
  report.contacts = contacts_at_rest_;
  state.half_velocity.assign(state.position.size(), Vec3::Zero());
  ++state.step;
  return report;
}

StepReport StaticSolver::solve(const Controls& controls, double time, const StaticOptions& options,
                               State& state) {
  StepReport report;
  const State start = state;
  const double start_time = state.time;
  std::fill(state.half_velocity.begin(), state.half_velocity.end(), Vec3::Zero());
  state.last_step = 0.0;
  state.time = time;  // for the loads; the pins follow below
  const Support support =
      find_support(model_, controls, time, outer_forces(model_, controls, state));
  const std::vector<Resting> resting =
      support.by_contact ? std::vector<Resting>{} : support.on_planes;
  proximal_stiffness_ = std::max(resting.empty() ? 0.0 : plane_stiffness(model_, controls),
                                 support.none ? free_stiffness(model_) : 0.0);
  put_at_rest_shape(model_, find_tangled(model_, find_low_tets(model_, state.position)), state);

  if (support.by_contact) {
    report.products = move_pins_to(controls, start_time, time, 1.0, state);
    return settle_by_contact(controls, options, start, report, state);
  }

  // The dead force makes the start of the solve a rest state, so the change to the new loads can be
  // cut into small steps.
  Field dead_force = forces_.evaluate(controls, state).force;
  keep_free(model_, dead_force);
  put_down(model_, controls, resting, state);

  const int turns =
      static_cast<int>(std::ceil(pins_turn(controls, start_time, time) / turn_per_load_step));
  double length = 1.0 / std::max({1, options.min_load_steps, turns});
  bool gradual = options.min_load_steps > 1;  // outer forces are applied gradually too
  NewtonReport falls;
  int cuts = 0;
  int failures = 0;
  int products_before = 0;  // until the first failure
  double done = 0.0;
  while (done < 1.0) {
    const double next = done + length > 1.0 - 1e-9 ? 1.0 : done + length;
    const State before = state;
    report.products += move_pins_to(controls, start_time, time, next, state);
    ++report.load_steps;
    const auto account = [&](const NewtonReport& r) {
      report.newton += r.newton;
      report.products += r.products;
      report.residual = r.residual;
      report.contacts = constraints_.contacts();
      report.limits_met = r.within;
      report.stopped = r.stopped && !r.rests;
      return r.rests || r.stopped;
    };
    const auto newton = [&](const Model& model, ForceEvaluator& forces, double tolerance) {
      const Objective objective{model, controls, &dead_force, gradual ? 1.0 - next : 0.0};
      NewtonOptions o{tolerance, options.max_newton, options.stop, {}};
      if (options.on_progress) {
        o.on_progress = [&, before_this = report.newton](const NewtonProgress& p) {
          options.on_progress({report.load_steps, next, before_this + p.newton, p.residual});
        };
      }
      return account(settle(objective, o, forces, state));
    };
    // Before the last load step it is enough to stay near the path.
    const double tolerance = next < 1.0 ? std::max(options.tolerance, 1e-3) : options.tolerance;
    const auto approach = [&] {  // in single precision; what that cannot do is left to double
      if (!in_single_) return;
      const State there = state;
      if (!newton(model_, *in_single_, std::max(tolerance, single_residual))) state = there;
    };
    if (!softened_) approach();
    if ((!softened_ || newton(softened_->model, softened_->forces, 1e-2)) &&
        (report.stopped || newton(model_, forces_, tolerance))) {
      done = next;
      if (report.stopped) break;
      if (cuts > 0) {
        --cuts;
        length *= 2.0;
      }
      continue;
    }
    ++cuts;
    const double failed = next;
    if (failures++ == 0) products_before = report.products;
    const double work = static_cast<double>(report.products - falls.products - products_before) *
                        static_cast<double>(model_.node_count());
    if (failed - done < shortest_load_step || work > share_of_steps * options.most_work ||
        report.newton - falls.newton > options.most_newton) {
      throw_no_rest(controls, time, options, start, report);
    }
    state = before;
    if (cuts == cuts_before_falling && falls.newton == 0) {
      const StaticProgress now{report.load_steps, 1.0, report.newton, 0.0};
      falls = relax_dynamically(controls, start_time, time, options, now, state);
      if (account(falls)) break;
    }
    state = before;
    gradual = true;
    length *= 0.5;
  }
  // Beside something to touch the place matters.
  if (support.none && resting.empty() && !ContactFinder::anything_to_find(model_))
    undo_drift(model_, controls, start.position, state.position);
  state.half_velocity.assign(state.position.size(), Vec3::Zero());
  ++state.step;
  return report;
}

}  // namespace sinew
