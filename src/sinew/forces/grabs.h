// Grabs: springs of rest length zero from nodes to points that are moved from outside, such as a
// hand that pulls. For node i with stiffness k_i and target p_i
//
//   W = k_i / 2 |p_i - x_i|^2,   force k_i (p_i - x_i),   second derivative k_i
//
// Only nodes that are free to move are pulled.
#pragma once

#include <span>

#include "sinew/model/controls.h"

namespace sinew {

// Calls f(node, k_i [N/m], target [m]) for every free node of every grab.
template <typename F>
void for_each_grabbed(const Model& model, const Controls& controls, const F& f) {
  for (const Grab& grab : controls.grabs) {
    for (std::size_t i = 0; i < grab.nodes.size(); ++i) {
      const Index node = grab.nodes[i];
      if (model.inverse_mass[uz(node)] == 0.0) continue;
      f(node, grab.stiffness[i], Vec3(grab.target + grab.offset[i]));
    }
  }
}

// Sum of W [J].
inline double grab_energy(const Model& model, const Controls& controls, std::span<const Vec3> x) {
  double sum = 0.0;
  for_each_grabbed(model, controls, [&](Index node, double k, const Vec3& target) {
    sum += 0.5 * k * (target - x[uz(node)]).squaredNorm();
  });
  return sum;
}

// Adds the grabs' forces to `forces` [N] (nodes).
inline void add_grab_forces(const Model& model, const Controls& controls, std::span<const Vec3> x,
                            std::span<Vec3> forces) {
  for_each_grabbed(model, controls, [&](Index node, double k, const Vec3& target) {
    forces[uz(node)] += k * (target - x[uz(node)]);
  });
}

// out += a H u, H the second derivative of W.
inline void add_grab_stiffness_times(const Model& model, const Controls& controls, double a,
                                     std::span<const Vec3> u, std::span<Vec3> out) {
  for_each_grabbed(model, controls, [&](Index node, double k, const Vec3&) {
    out[uz(node)] += a * k * u[uz(node)];
  });
}

// What one grab pulls its nodes with in all, the pinned ones left out [N].
inline Vec3 grab_pull(const Model& model, const Grab& grab, std::span<const Vec3> x) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < grab.nodes.size(); ++i) {
    const auto n = uz(grab.nodes[i]);
    if (model.inverse_mass[n] > 0.0)
      sum += grab.stiffness[i] * (grab.target + grab.offset[i] - x[n]);
  }
  return sum;
}

}  // namespace sinew
