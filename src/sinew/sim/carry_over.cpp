#include "sinew/sim/carry_over.h"

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

// The motion of a body as a whole: that of a rigid one with its momentum and angular momentum.
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

}  // namespace

void calm_softened_bodies(const Model& before, const Model& after, State& state) {
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
