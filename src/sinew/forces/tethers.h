// Tethers: springs of rest length zero from nodes to points that are moved from outside, such as a
// hand that pulls. For node i with stiffness k_i and target p_i
//
//   W = k_i / 2 |p_i - x_i|^2,   force k_i (p_i - x_i),   second derivative k_i
//
// Only nodes that are free to move are pulled.
#pragma once

#include <span>

#include "sinew/model/model.h"

namespace sinew {

// Calls f(node, k_i [N/m], target [m]) for every free node of every tether.
template <typename F>
void for_each_tethered(const Model& model, const F& f) {
  for (const Tether& tether : model.tethers) {
    for (std::size_t i = 0; i < tether.nodes.size(); ++i) {
      const Index node = tether.nodes[i];
      if (model.inverse_mass[uz(node)] == 0.0) continue;
      f(node, tether.stiffness[i], Vec3(tether.target + tether.offset[i]));
    }
  }
}

// Sum of W [J].
inline double tether_energy(const Model& model, std::span<const Vec3> x) {
  double sum = 0.0;
  for_each_tethered(model, [&](Index node, double k, const Vec3& target) {
    sum += 0.5 * k * (target - x[uz(node)]).squaredNorm();
  });
  return sum;
}

// Adds the tethers' forces to `forces` [N] (nodes).
inline void add_tether_forces(const Model& model, std::span<const Vec3> x, std::span<Vec3> forces) {
  for_each_tethered(model, [&](Index node, double k, const Vec3& target) {
    forces[uz(node)] += k * (target - x[uz(node)]);
  });
}

// out += a H u, H the second derivative of W.
inline void add_tether_stiffness_times(const Model& model, double a, std::span<const Vec3> u,
                                       std::span<Vec3> out) {
  for_each_tethered(
      model, [&](Index node, double k, const Vec3&) { out[uz(node)] += a * k * u[uz(node)]; });
}

// What one tether pulls its nodes with in all, the pinned ones left out [N].
inline Vec3 tether_pull(const Model& model, const Tether& tether, std::span<const Vec3> x) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < tether.nodes.size(); ++i) {
    const auto n = uz(tether.nodes[i]);
    if (model.inverse_mass[n] > 0.0)
      sum += tether.stiffness[i] * (tether.target + tether.offset[i] - x[n]);
  }
  return sum;
}

}  // namespace sinew
