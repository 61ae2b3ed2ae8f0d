#include "sinew/solver/implicit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sinew/base/error.h"
#include "sinew/base/parallel.h"
#include "sinew/forces/heat.h"
#include "sinew/forces/inversion_recovery.h"
#include "sinew/forces/loads.h"
#include "sinew/forces/obstacles.h"
#include "sinew/forces/terms.h"

namespace sinew {
namespace {

constexpr double single_tolerance = 1e-3;

// d / h, the length of a stage: g / 2 of TR-BDF2 is the same number as g of SDIRK2.
const double stage_share = 1.0 - std::sqrt(0.5);

// a x + b y of all nodes.
Field blend(double a, const Field& x, double b, const Field& y) {
  Field out(x.size());
  parallel_for(static_cast<Index>(x.size()),
               [&](Index i) { out[uz(i)] = a * x[uz(i)] + b * y[uz(i)]; });
  return out;
}

// Moves the pinned nodes to their positions at state.time.
void move_pins(const Model& model, const Controls& controls, State& state) {
  for (std::size_t p = 0; p < model.pins.size(); ++p) {
    for (const Index node : model.pins[p].nodes) {
      state.position[uz(node)] =
          controls.pin_paths[p].at(state.time, model.rest_position[uz(node)]);
    }
  }
}

// The work of loads, pins, soft obstacles and tools on the displacement u of the nodes, and of the
// spheres from the time `from` to `to`, with the forces in the configuration `at`. nodal_force: of
// the model and the constraints on all nodes there [N].
double work_of_the_outside(const Configuration& at, const Field& nodal_force, const Field& u,
                           double from, double to) {
  double work = 0.0;
  for_each_load_force(at.model, at.x, at.time, [&](Index node, const Vec3& force) {
    if (at.model.inverse_mass[uz(node)] > 0.0) work += force.dot(u[uz(node)]);
  });
  for (const Pin& pin : at.model.pins) {
    for (const Index node : pin.nodes) work -= nodal_force[uz(node)].dot(u[uz(node)]);
  }
  for_each_work_on_spheres(at, from, to, [&](double of_one) { work -= of_one; });
  return work;
}

// A point of a step: the state there and the forces on its nodes [N].
struct Point {
  Field x;
  double time = 0.0;
  Field nodal_force;
};

// The work between two points by the trapezoidal rule.
double work_between(const Model& model, const Controls& controls, const Point& a, const Point& b) {
  const Field u = blend(1.0, b.x, -1.0, a.x);
  return 0.5 *
         (work_of_the_outside({model, controls, a.x, a.time}, a.nodal_force, u, a.time, b.time) +
          work_of_the_outside({model, controls, b.x, b.time}, b.nodal_force, u, a.time, b.time));
}

}  // namespace

bool may_take_single(const Model& model, double tolerance) {
  return tolerance >= single_tolerance && model.limited.empty() && !model.has_volume_limit &&
         !ContactFinder::anything_to_find(model);
}

ImplicitStepper::ImplicitStepper(const Model& model)
    : model_(model),
      layout_(std::make_shared<PackedLayout>(model)),
      forces_(model, Precision::double_),
      linear_(model, layout_) {}

void ImplicitStepper::prepare(double h, const Controls& controls, const ImplicitOptions& options) {
  if (options.scheme != Scheme::backward_euler) h *= stage_share;
  linear_.factor({.model = model_, .controls = controls, .inertia = 1.0 / (h * h), .rate = 1.0 / h},
                 0.0);
}

ForceEvaluator& ImplicitStepper::evaluator(const ImplicitOptions& options) {
  if (!options.single || !may_take_single(model_, options.tolerance)) return forces_;
  if (!in_single_) in_single_.emplace(model_, Precision::single, layout_);
  return *in_single_;
}

// Backward Euler over h from the positions `from` with `velocity`, dashpots in their directions at
// state.position, loads and pins at state.time. Contacts are searched on the path from `path`,
// where the nodes were `path_time` [s] before state.time. Moves the state's positions and sets its
// velocities. Returns the forces of the model and the constraints on all nodes at the end [N], or
// nothing if no equilibrium was found.
std::optional<Field> ImplicitStepper::solve(const Field& from, const Field& velocity, double h,
                                            const Field& path, double path_time,
                                            const Controls& controls,
                                            const ImplicitOptions& options, State& state,
                                            StepReport& report) {
  const double inertia = 1.0 / (h * h);
  // Frames end at round times, so the last digits of h differ from frame to frame. Rounded, the
  // kept data are the same as those that a resumed run computes again.
  const double about = static_cast<double>(static_cast<float>(inertia));
  if (constrained_inertia_ != about) {
    constraints_ = std::make_unique<Constraints>(model_, about, std::sqrt(about), true);
    constrained_inertia_ = about;
  }
  constraints_->start(controls, state, &path, path_time);
  const Field lagged = state.position;
  const Field inertial = blend(1.0, from, h, velocity);
  std::fill(state.half_velocity.begin(), state.half_velocity.end(), Vec3::Zero());
  const Objective objective{
      model_,    controls, nullptr, 0.0,     inertia,
      &inertial, 1.0 / h,  &from,   &lagged, constraints_->empty() ? nullptr : constraints_.get()};
  const NewtonOptions newton_options{
      options.tolerance, options.max_newton, options.stop, {}, options.deadline};
  ForceEvaluator& forces = evaluator(options);
  move_pins(model_, controls, state);
  const Field start = state.position;
  const double start_value = options.deadline ? objective_value(objective, state, forces) : 0.0;
  // Starts from the inertial positions; with a deadline only if their objective is below that of
  // the current ones.
  state.position = inertial;
  move_pins(model_, controls, state);
  if (options.deadline && !(objective_value(objective, state, forces) < start_value)) {
    state.position = start;
  }
  NewtonReport newton =
      minimise_augmented_lagrangian(objective, linear_, newton_options, forces, state);
  report.newton += newton.newton;
  report.products += newton.products;
  if (!newton.rests && !newton.stopped &&
      !options.deadline) {  // starts again from the old positions
    state.position = start;
    constraints_->start(controls, state, &path, path_time);
    newton = minimise_augmented_lagrangian(objective, linear_, newton_options, forces_, state);
    report.newton += newton.newton;
    report.products += newton.products;
  }
  report.stopped = newton.stopped && !newton.rests;
  if (report.stopped) return std::nullopt;
  report.residual = std::max(report.residual, newton.residual);
  report.ran_out = report.ran_out || newton.ran_out;
  report.contacts = constraints_->contacts();
  report.deepest = constraints_->contact_constraints().deepest(state.position);
  report.limits_met = report.limits_met && newton.within;
  constraints_->store(state);
  state.half_velocity = blend(1.0 / h, state.position, -1.0 / h, from);
  const bool taken = newton.rests || (options.deadline && newton.force < no_limit);
  if (!taken) return std::nullopt;
  return std::move(newton.nodal_force);
}

bool ImplicitStepper::tr_bdf2(double h, const Controls& controls, const ImplicitOptions& options,
                              State& state, StepReport& report) {
  const double g = 2.0 - std::sqrt(2.0);
  const double d = stage_share * h;
  const Field v = state.half_velocity;
  const NodalForces& at_start = evaluator(options).evaluate(controls, state);
  const Point start{state.position, state.time, at_start.force};
  Field a = at_start.force;
  parallel_for(model_.node_count(), [&](Index i) { a[uz(i)] *= model_.inverse_mass[uz(i)]; });
  // As a Runge-Kutta method its weights are sqrt(2)/4, sqrt(2)/4 and d / h.
  double heat = 0.25 * std::sqrt(2.0) * h * at_start.heat;

  state.time = start.time + g * h;
  auto nodal_force = solve(blend(1.0, start.x, d, v), blend(1.0, v, d, a), d, start.x, g * h,
                           controls, options, state, report);
  if (!nodal_force) return false;
  if (any_active(state.reactions)) return true;
  const Point middle{state.position, state.time, std::move(*nodal_force)};
  const Field v1 = state.half_velocity;
  heat += 0.25 * std::sqrt(2.0) * h * damping_power(model_, start.x, v1, v1);

  // The second stage starts from extrapolated positions, which may be beyond a thin body or
  // obstacle. Contacts are searched from the end of the first stage. One that acts leads to
  // backward Euler.
  const double c = 1.0 / (g * (2.0 - g));
  state.time = start.time + h;
  nodal_force = solve(blend(c, middle.x, 1.0 - c, start.x), blend(c, v1, 1.0 - c, v), d, middle.x,
                      (1.0 - g) * h, controls, options, state, report);
  if (!nodal_force) return false;
  const Point end{state.position, state.time, std::move(*nodal_force)};
  heat += d * damping_power(model_, middle.x, state.half_velocity, state.half_velocity);
  state.energy.dissipated += heat;
  state.energy.work_in +=
      work_between(model_, controls, start, middle) + work_between(model_, controls, middle, end);
  return true;
}

bool ImplicitStepper::sdirk2(double h, const Controls& controls, const ImplicitOptions& options,
                             State& state, StepReport& report) {
  const Field x = state.position;
  const Field v = state.half_velocity;
  const double time = state.time;
  const double g = stage_share;
  state.time = time + g * h;
  auto nodal_force = solve(x, v, g * h, x, g * h, controls, options, state, report);
  if (!nodal_force) return false;
  if (any_active(state.reactions)) return true;
  const Field v1 = state.half_velocity;
  const Point middle{state.position, state.time, std::move(*nodal_force)};
  state.energy.dissipated += (1.0 - g) * h * damping_power(model_, x, v1, v1);
  state.energy.work_in +=
      work_of_the_outside({model_, controls, middle.x, middle.time}, middle.nodal_force,
                          blend(1.0, middle.x, -1.0, x), time, middle.time);
  state.time = time + h;
  nodal_force =
      solve(blend(1.0, x, (1.0 - g) * h, v1), blend(1.0 - (1.0 - g) / g, v, (1.0 - g) / g, v1),
            g * h, middle.x, (1.0 - g) * h, controls, options, state, report);
  if (!nodal_force) return false;
  const Point end{state.position, state.time, std::move(*nodal_force)};
  state.energy.dissipated +=
      g * h * damping_power(model_, middle.x, state.half_velocity, state.half_velocity);
  state.energy.work_in += work_between(model_, controls, middle, end);
  return true;
}

bool ImplicitStepper::backward_euler(double h, const Controls& controls,
                                     const ImplicitOptions& options, State& state,
                                     StepReport& report) {
  const Field x = state.position;
  const Field v = state.half_velocity;
  state.time += h;
  const auto nodal_force = solve(x, v, h, x, h, controls, options, state, report);
  if (!nodal_force) return false;
  state.energy.dissipated += h * damping_power(model_, x, state.half_velocity, state.half_velocity);
  state.energy.work_in +=
      work_of_the_outside({model_, controls, state.position, state.time}, *nodal_force,
                          blend(1.0, state.position, -1.0, x), state.time - h, state.time);
  if (constraints_->empty()) return true;
  // The work of the impulses of contacts and limits uses the mean of the velocities before and
  // after the step, as in Verlet's energy balance: it is 0 for a body at rest.
  Field reaction(x.size(), Vec3::Zero());
  constraints_->add_reactions(state.position, forces_.tets(state.position), reaction);
  keep_free(model_, reaction);
  const double gained = 0.5 * h * (dot(reaction, v) + dot(reaction, state.half_velocity));
  const double moved = constraints_->contact_constraints().work_of_obstacles();
  // Reactions that lead nodes back to their bounds put work in, so that heat only grows.
  const double put_in = std::max(moved, gained);
  report.led_out += put_in - moved;
  state.energy.work_in += put_in;
  state.energy.dissipated += put_in - gained;
  report.friction += constraints_->contact_constraints().work_of_friction(state.position);
  return true;
}

bool ImplicitStepper::try_step(double h, const Controls& controls, const ImplicitOptions& options,
                               State& state, StepReport& report) {
  state.last_step = 0.0;  // the velocity is that at state.time
  bool done = false;
  if (options.scheme != Scheme::backward_euler && !any_active(state.reactions)) {
    const State before = state;
    const bool found = options.scheme == Scheme::tr_bdf2
                           ? tr_bdf2(h, controls, options, state, report)
                           : sdirk2(h, controls, options, state, report);
    if (!found) return false;
    done = !any_active(state.reactions);
    if (!done) state = before;
  }
  if (!done && !backward_euler(h, controls, options, state, report)) return false;
  ++state.step;
  return true;
}

StepReport ImplicitStepper::step(double h, const Controls& controls, const ImplicitOptions& options,
                                 State& state) {
  const std::vector<Index> tangled = find_tangled(model_, find_low_tets(model_, state.position));
  if (!tangled.empty()) return recover(tangled, h, controls, options, state);
  return advance(h, controls, options, state);
}

// Takes the step; cuts it in half if Newton's method does not converge.
StepReport ImplicitStepper::advance(double h, const Controls& controls,
                                    const ImplicitOptions& options, State& state) {
  StepReport report;
  const State start = state;
  double length = h;
  int parts = 1;  // of the step, all of length `length`
  int done = 0;
  for (int cuts = 0; done < parts;) {
    const State before = state;
    const double residual = report.residual;
    if (try_step(length, controls, options, state, report)) {
      ++done;
      continue;
    }
    if (report.stopped) {
      state = start;
      return report;
    }
    state = before;  // the report keeps the cost of the attempt, but not its residual
    report.residual = residual;
    if (++cuts > options.most_cuts) {
      throw Error(
          ErrorKind::diverged,
          fmt::format("the implicit step from t = {:.6g} s was cut {} times and still found "
                      "no equilibrium of forces",
                      start.time, options.most_cuts),
          "take a smaller dt, a larger tolerance, or slower pins and loads");
    }
    ++report.cuts;
    length *= 0.5;
    parts = 2 * (parts - done);
    done = 0;
  }
  return report;
}

}  // namespace sinew
