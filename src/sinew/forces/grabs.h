// Grabs: springs of rest length zero from nodes to points that a user moves, such as a hand. For
// node i with stiffness k_i and target p_i
//
//   W = k_i / 2 |p_i - x_i|^2,   force k_i (p_i - x_i),   second derivative k_i
//
// Only free nodes are pulled.
#pragma once

#include "sinew/forces/term.h"

namespace sinew {

struct GrabTerm {
  static constexpr Account account = Account::contact;
  static constexpr bool holds = true;

  static double energy(const Configuration& at) {
    double sum = 0.0;
    for_each_grabbed(at, [&](Index node, double k, const Vec3& target) {
      sum += 0.5 * k * (target - at.x[uz(node)]).squaredNorm();
    });
    return sum;
  }
  static void add_forces(const Configuration& at, std::span<Vec3> forces) {
    for_each_grabbed(at, [&](Index node, double k, const Vec3& target) {
      forces[uz(node)] += k * (target - at.x[uz(node)]);
    });
  }
  template <class F>
  static void for_each_element(const Configuration& at, Tangent, const F& visit) {
    for_each_grabbed(at, [&](Index node, double k, const Vec3&) {
      constexpr double one = 1.0;
      visit(Element{{&node, 1}, {&one, 1}, k * Mat3::Identity(), k});
    });
  }

 private:
  // Calls f(node, k_i [N/m], target [m]) for every free node of every grab.
  template <class F>
  static void for_each_grabbed(const Configuration& at, const F& f) {
    for (const Grab& grab : at.controls.grabs) {
      for (std::size_t i = 0; i < grab.nodes.size(); ++i) {
        const Index node = grab.nodes[i];
        if (at.model.inverse_mass[uz(node)] == 0.0) continue;
        f(node, grab.stiffness[i], Vec3(grab.target + grab.offset[i]));
      }
    }
  }
};

// The total force of a grab on its free nodes [N].
inline Vec3 grab_force(const Model& model, const Grab& grab, std::span<const Vec3> x) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < grab.nodes.size(); ++i) {
    const auto n = uz(grab.nodes[i]);
    if (model.inverse_mass[n] > 0.0)
      sum += grab.stiffness[i] * (grab.target + grab.offset[i] - x[n]);
  }
  return sum;
}

}  // namespace sinew
