// All springs of a model: forces, energy, stretch.
#pragma once

#include <span>
#include <vector>

#include "sinew/model/state.h"

namespace sinew {

// Sets `force`, the force on end 0 of each active spring [N] (springs), from positions and
// half-step velocities. Returns the power [W] that the dashpots turn into heat.
double compute_spring_forces(const Model& model, const State& state, std::vector<Vec3>& force);

// Sum over springs of k/2 (|x_ij| - l0)^2 [J].
double spring_energy(const Model& model, std::span<const Vec3> x);

// x_ij| / l0 - 1 over the bodies' springs [-]: the largest value, and the negative of the smallest.
struct StretchRange {
  double stretch = 0.0;   // longest: 0.25 means 25 % longer than at rest
  double compress = 0.0;  // shortest: 0.25 means 25 % shorter than at rest
  Index longest = -1;     // spring ids, -1: none
  Index shortest = -1;
};
StretchRange measure_stretch(const Model& model, std::span<const Vec3> x);

// The sum of the forces on a node over its springs, in their fixed order. `force`: on end 0 of each
// spring (springs).
inline Vec3 gather_springs(const Model& model, const std::vector<Vec3>& force, Index node) {
  Vec3 sum = Vec3::Zero();
  const auto n = uz(node);
  for (Index k = model.spring_start[n]; k < model.spring_start[n + 1]; ++k) {
    const Index s = model.node_spring[uz(k)];
    const Vec3& f = force[static_cast<std::size_t>(s >> 1)];
    if (s & 1) {
      sum -= f;
    } else {
      sum += f;
    }
  }
  return sum;
}

}  // namespace sinew
