#include "sinew/solver/verlet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sinew/base/error.h"
#include "sinew/base/parallel.h"
#include "sinew/contact/planes.h"
#include "sinew/forces/heat.h"
#include "sinew/forces/inversion_recovery.h"
#include "sinew/forces/loads.h"
#include "sinew/forces/node_kernels.h"
#include "sinew/forces/obstacles.h"
#include "sinew/forces/springs.h"
#include "sinew/forces/strain_limits.h"
#include "sinew/forces/terms.h"

namespace sinew {
namespace {

constexpr Index none = std::numeric_limits<Index>::max();

// A node this far away [m] has run away: its position is finite, but cannot be displayed.
constexpr double farthest = 1e9;

// Moves the free nodes. Returns the first node that is not finite or has run away, or `none`.
Index move_free_nodes(const Model& model, const std::vector<Vec3>& force, double h, State& state) {
  const double mean_step = 0.5 * (state.last_step + h);
  const int within = parallel_reduce(
      model.node_count(), 1,
      [&](Range r) { return leapfrog(model, force, mean_step, h, farthest, r, state) ? 1 : 0; },
      [](int a, int b) { return a & b; });
  if (within != 0) return none;
  for (Index i = 0; i < model.node_count(); ++i) {
    const bool near = (state.position[uz(i)].array().abs() <= farthest).all();
    if (model.inverse_mass[uz(i)] > 0.0 && !near) return i;
  }
  return none;
}

// Moves the pinned nodes along their paths; adds the work of their motion.
void move_pins(const Model& model, const Controls& controls, const std::vector<Vec3>& force,
               double h, State& state) {
  const double mean_step = 0.5 * (state.last_step + h);
  for (std::size_t p = 0; p < model.pins.size(); ++p) {
    const Path& path = controls.pin_paths[p];
    if (path.keys.empty()) continue;
    for (const Index node : model.pins[p].nodes) {
      const auto k = uz(node);
      const Vec3 target = path.at(state.time + h, model.rest_position[k]);
      const Vec3 velocity = (target - state.position[k]) / h;
      const Vec3 mean = 0.5 * (state.half_velocity[k] + velocity);
      state.energy.work_in -= mean_step * force[k].dot(mean);
      state.half_velocity[k] = velocity;
      state.position[k] = target;
    }
  }
}

// Work of the loads in the step, with v(t) = (w before + w after) / 2; called before the move.
void add_work_of_loads(const Model& model, const std::vector<Vec3>& force, double h, State& state) {
  const double mean_step = 0.5 * (state.last_step + h);
  for_each_load_force(model, state.position, state.time, [&](Index node, const Vec3& load) {
    const auto k = uz(node);
    const Vec3 v = state.half_velocity[k] + (0.5 * mean_step * model.inverse_mass[k]) * force[k];
    state.energy.work_in += mean_step * load.dot(v);
  });
}

// Work of the soft obstacles and tools that move over the step: their forces on the bodies times
// their own displacement, with the velocity (c(t + h) - c(t - h_last)) / (h + h_last); called
// before the move.
void add_work_of_obstacles(const Model& model, const Controls& controls, double h, State& state) {
  for_each_work_on_spheres(configuration(model, controls, state), state.time - state.last_step,
                           state.time + h,
                           [&](double work) { state.energy.work_in -= 0.5 * work; });
}

// Makes the velocities follow positions that constraints have moved, and counts the energy. The
// work of the impulses uses the mean of the velocities before and after the step, as in Verlet's
// energy balance: it is 0 for a taut spring at rest.
void follow_positions(const Model& model, const std::vector<Vec3>& force,
                      const std::vector<Vec3>& predicted, double h, State& state,
                      StepReport& report) {
  const double mean_step = 0.5 * (state.last_step + h);
  const double gained = parallel_sum(model.node_count(), [&](Index i) {
    const auto k = uz(i);
    if (model.inverse_mass[k] == 0.0) return 0.0;
    const Vec3 change = (state.position[k] - predicted[k]) / h;
    const Vec3 before = state.half_velocity[k] - (mean_step * model.inverse_mass[k]) * force[k];
    state.half_velocity[k] += change;
    return 0.5 * model.mass[k] * change.dot(before + state.half_velocity[k]);
  });
  // Limits that pull, as when a pin moves or a step starts beyond them, put work in.
  report.led_out += std::max(0.0, gained);
  state.energy.work_in += std::max(0.0, gained);
  state.energy.dissipated += std::max(0.0, -gained);
}

// Projects the limits, with hard planes as additional constraints; velocities follow.
void enforce_limits(const Model& model, const Controls& controls, const std::vector<Vec3>& force,
                    double h, State& state, StepReport& report) {
  const std::vector<Vec3> predicted = state.position;
  LimitSweep sweep{1, 1};
  while (sweep.over > 0 && report.limit_sweeps < model.limit_sweeps) {
    sweep = sweep_limits(model, state.position);
    if (sweep.moved > 0) {
      ++report.limit_sweeps;
      lift_onto_planes(model, controls, state.time + h, state.position);
    }
  }
  if (report.limit_sweeps == 0) return;
  report.limits_met =
      sweep.over == 0 || measure_limit_violation(model, state.position) <= model.limit_tolerance;

  follow_positions(model, force, predicted, h, state, report);
}

// Projects the limited cells back to their volume; velocities follow.
void enforce_volume(const Model& model, const std::vector<Vec3>& force, double h,
                    VolumeLimit& limit, State& state, StepReport& report) {
  const std::vector<Vec3> predicted = state.position;
  const VolumeLimitReport volume = limit.enforce(model, state.position);
  report.limits_met = report.limits_met && volume.within;
  if (volume.projections > 0) follow_positions(model, force, predicted, h, state, report);
}

// The speed of shear waves in the body's stiffest material at rest, sqrt(mu / rho) [m/s].
double shear_wave_speed(const Model& model, const Body& body) {
  double mass = 0.0, volume = 0.0, modulus = 0.0;
  for (Index i = body.nodes.begin; i < body.nodes.end; ++i) mass += model.mass[uz(i)];
  for (Index t = body.tets.begin; t < body.tets.end; ++t) {
    volume += model.rest_volume[uz(t)];
    modulus = std::max(modulus, model.tet_modulus[uz(t)]);
  }
  return std::sqrt(modulus * volume / mass);
}

// The spring at the node with the largest force, or with a force that is not finite.
Index suspect_spring(const Model& model, const State& state, Index node) {
  std::vector<Vec3> force;
  compute_spring_forces(model, state, force);
  Index suspect = -1;
  double worst = -1.0;
  for (Index k = model.spring_start[uz(node)]; k < model.spring_start[uz(node) + 1]; ++k) {
    const Index s = model.node_spring[uz(k)] >> 1;
    const double size = force[uz(s)].norm();
    if (!(size <= worst)) {
      suspect = s;
      worst = size;
    }
  }
  return suspect;
}

[[noreturn]] void report_divergence(const Model& model, const State& state, Index node) {
  std::string spring;
  const Index s = suspect_spring(model, state, node);
  if (s >= 0) {
    spring = fmt::format(
        "; its spring {} ({} to {}, k = {:.4g} N/m, l0 = {:.4g} m) carries the largest force", s,
        model.node_name(model.springs[uz(s)][0]), model.node_name(model.springs[uz(s)][1]),
        model.stiffness[uz(s)], model.rest_length[uz(s)]);
  }
  throw Error(ErrorKind::diverged,
              fmt::format("the state {} at t = {:.6g} s (step {}): {}{}",
                          state.position[uz(node)].allFinite() ? "has run away beyond 1e9 m"
                                                               : "is not finite",
                          state.time, state.step, model.node_name(node), spring),
              "take dt = \"auto\", or a smaller dt or more substeps");
}

// Throws if a hard obstacle moves through a tangled body faster than its shear waves: the material
// cannot give way, is torn inside out, and what inversion recovery would do to it is not a blow any
// more.
void refuse_torn_bodies(const Model& model, const Controls& controls,
                        const std::vector<Index>& tangled, const State& state) {
  for (const ContactForce& c : state.reactions.contacts) {
    const Index o = c.id.obstacle();
    if (o < 0 || state.last_step == 0.0) continue;
    const auto centre = [&](double time) {
      return controls.obstacle_paths[uz(o)].at(time, model.obstacles[uz(o)].center);
    };
    const double speed =
        (centre(state.time) - centre(state.time - state.last_step)).norm() / state.last_step;
    for (const Index b : tangled) {
      const Body& body = model.bodies[uz(b)];
      if (!body.nodes.contains(c.node[0])) continue;
      const double waves = shear_wave_speed(model, body);
      if (speed <= waves) continue;
      throw Error(
          ErrorKind::diverged,
          fmt::format("at t = {:.6g} s (step {}) the obstacle {} has turned tets of body {} inside "
                      "out: it moves at {:.3g} m/s, and the body's shear waves only at {:.3g} m/s, "
                      "so the tissue cannot give way",
                      state.time, state.step, model.obstacles[uz(o)].name, body.name, speed, waves),
          "a slower obstacle, a stiffer material, or smaller cells than the obstacle is thick");
    }
  }
}

}  // namespace

VerletStepper::VerletStepper(const Model& model, Precision precision)
    : model_(model), forces_(model, precision) {
  if (ExplicitContacts::any(model)) contacts_.emplace(model);
}

// The power of the damping forces on the mean of the half-step velocities before and after the
// step: what they take from the energy m/2 w- . w+. Impacts change the velocities so much that the
// power of the velocities before the step, which costs nothing, is wrong by a share of the impact.
double VerletStepper::heat_of_impacts(const State& state) {
  std::vector<Vec3>& mean = mean_velocity_;
  mean.resize(state.half_velocity.size());
  parallel_for(model_.node_count(), [&](Index i) {
    mean[uz(i)] = 0.5 * (velocity_before_[uz(i)] + state.half_velocity[uz(i)]);
  });
  return damping_power(model_, before_, velocity_before_, mean);
}

StepReport VerletStepper::step(double h, const Controls& controls, State& state) {
  StepReport report;
  const double mean_step = 0.5 * (state.last_step + h);
  const NodalForces& found = forces_.evaluate(controls, state);
  const double heat = found.heat;
  const std::vector<Index> tangled = find_tangled(model_, found.low_tets);
  if (!tangled.empty()) refuse_torn_bodies(model_, controls, tangled, state);
  report.recovered = static_cast<int>(tangled.size());
  double energy = 0.0;
  std::vector<Vec3> recovering;
  if (!tangled.empty()) {
    energy = measure_energies(model_, controls, state, found.force).total();
    recovering = recovery_forces(model_, state, h, tangled, found.force);
  }
  const std::vector<Vec3>& force = tangled.empty() ? found.force : recovering;
  if (contacts_) {
    before_ = state.position;
    velocity_before_ = state.half_velocity;
  }
  add_work_of_loads(model_, force, h, state);
  add_work_of_obstacles(model_, controls, h, state);
  const Index broken = move_free_nodes(model_, force, h, state);
  move_pins(model_, controls, force, h, state);
  if (broken == none) {
    if (contacts_) {
      const ContactReport contact = contacts_->step(controls, before_, force, h, state);
      report.contacts = contact.contacts;
      report.deepest = contact.deepest;
      report.friction = contact.friction;
      report.led_out = contact.made;
    }
    if (!model_.limited.empty()) enforce_limits(model_, controls, force, h, state, report);
    if (model_.has_volume_limit) enforce_volume(model_, force, h, volume_limit_, state, report);
  }
  state.energy.dissipated += mean_step * (contacts_ ? heat_of_impacts(state) : heat);
  state.last_step = h;
  state.time += h;
  ++state.step;
  if (!tangled.empty()) {
    const NodalForces& after = forces_.evaluate(controls, state);
    report.recovery_work = measure_energies(model_, controls, state, after.force).total() - energy;
    state.energy.work_in += report.recovery_work;
  }
  guard_frequency2_ = sinew::guard_frequency2(model_, found.low_tets);  // of the last forces
  if (broken != none) report_divergence(model_, state, broken);
  return report;
}

}  // namespace sinew
