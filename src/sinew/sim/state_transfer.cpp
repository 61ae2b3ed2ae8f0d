#include "sinew/sim/state_transfer.h"

#include <algorithm>
#include <cmath>

namespace sinew {
namespace {

double mean_modulus(const Model& model, const Body& body) {
  double sum = 0.0;
  for (Index t = body.tets.begin; t < body.tets.end; ++t) {
    sum += model.tet_modulus[uz(t)] * model.rest_volume[uz(t)];
  }
  return sum / body.rest_volume;
}

// The rigid motion of a body: that of a rigid body with the same momentum and angular momentum.
struct Motion {
  Vec3 center = Vec3::Zero();    // [m]
  Vec3 velocity = Vec3::Zero();  // [m/s]
  Vec3 spin = Vec3::Zero();      // [rad/s]

  Vec3 at(const Vec3& x) const { return velocity + spin.cross(x - center); }
};

Motion motion_of(const Model& model, const Body& body, const State& state) {
  Motion m;
  double mass = 0.0;
  for (Index i = body.nodes.begin; i < body.nodes.end; ++i) {
    const double share = model.mass[uz(i)];
    mass += share;
    m.center += share * state.position[uz(i)];
    m.velocity += share * state.half_velocity[uz(i)];
  }
  m.center /= mass;
  m.velocity /= mass;
  Mat3 inertia = Mat3::Zero();
  Vec3 angular = Vec3::Zero();
  for (Index i = body.nodes.begin; i < body.nodes.end; ++i) {
    const double share = model.mass[uz(i)];
    const Vec3 r = state.position[uz(i)] - m.center;
    inertia += share * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
    angular += share * r.cross(state.half_velocity[uz(i)] - m.velocity);
  }
  const Vec3 spin = inertia.inverse() * angular;
  if (spin.allFinite()) m.spin = spin;
  return m;
}

// The number of nodes before those of mesh obstacles.
Index own_nodes(const Model& model) {
  Index count = model.node_count();
  for (const Obstacle& o : model.obstacles) count -= o.nodes().size();
  return count;
}

}  // namespace

const Obstacle* obstacle_named(const Model& model, const std::string& name) {
  const auto found = std::find_if(model.obstacles.begin(), model.obstacles.end(),
                                  [&](const Obstacle& o) { return o.name == name; });
  return found == model.obstacles.end() ? nullptr : &*found;
}

// The nodes of mesh obstacles come last. Those of obstacles that stay keep their state; the others
// get the positions that the controls give them.
State transfer_state(const Model& before, const State& old, const Model& after,
                     const Controls& controls, const std::string& replaced) {
  State s = initial_state(after);
  const auto common = own_nodes(after);
  std::copy_n(old.position.begin(), common, s.position.begin());
  std::copy_n(old.half_velocity.begin(), common, s.half_velocity.begin());
  s.last_step = old.last_step;
  s.time = old.time;
  s.step = old.step;
  s.energy = old.energy;
  s.obstacle_force.assign(after.obstacles.size(), Vec3::Zero());
  for (std::size_t o = 0; o < after.obstacles.size(); ++o) {
    const Obstacle& now = after.obstacles[o];
    const Obstacle* known = now.name == replaced ? nullptr : obstacle_named(before, now.name);
    if (known != nullptr) {
      const auto at = static_cast<std::size_t>(known - before.obstacles.data());
      if (at < old.obstacle_force.size()) s.obstacle_force[o] = old.obstacle_force[at];
      std::copy_n(old.position.begin() + known->nodes().begin, known->nodes().size(),
                  s.position.begin() + now.nodes().begin);
      std::copy_n(old.half_velocity.begin() + known->nodes().begin, known->nodes().size(),
                  s.half_velocity.begin() + now.nodes().begin);
    } else {
      for (Index i = now.nodes().begin; i < now.nodes().end; ++i)
        s.position[uz(i)] = controls.obstacle_paths[o].at(s.time, after.rest_position[uz(i)]);
    }
  }
  return s;
}

void damp_softened_bodies(const Model& before, const Model& after, State& state) {
  for (std::size_t b = 0; b < after.bodies.size(); ++b) {
    const Body& body = after.bodies[b];
    const double ratio = mean_modulus(after, body) / mean_modulus(before, before.bodies[b]);
    if (!(ratio < 1.0)) continue;
    const Motion motion = motion_of(after, body, state);
    for (Index i = body.nodes.begin; i < body.nodes.end; ++i) {
      if (after.inverse_mass[uz(i)] == 0.0) continue;
      Vec3& v = state.half_velocity[uz(i)];
      const Vec3 whole = motion.at(state.position[uz(i)]);
      v = whole + std::sqrt(ratio) * (v - whole);
    }
  }
}

}  // namespace sinew
