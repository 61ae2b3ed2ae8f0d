// Cables: springs between two nodes that pull where they are longer than at rest and never push.
//
//   W = k/2 max(0, |x_ij| - l0)^2
#pragma once

#include <array>

#include "sinew/forces/term.h"

namespace sinew {

struct CableTerm {
  static constexpr Account account = Account::elastic;
  static constexpr bool isotropic = false;

  static double energy(const Configuration& at) {
    double sum = 0.0;
    for_each_taut(at, [&](const Cable& cable, const Vec3& x_ij) {
      const double longer = x_ij.norm() - cable.rest_length;
      sum += 0.5 * cable.stiffness * longer * longer;
    });
    return sum;
  }
  static void add_forces(const Configuration& at, std::span<Vec3> forces) {
    for_each_taut(at, [&](const Cable& cable, const Vec3& x_ij) {
      const Vec3 pull = cable.stiffness * (1.0 - cable.rest_length / x_ij.norm()) * x_ij;
      forces[uz(cable.ends[0])] += pull;
      forces[uz(cable.ends[1])] -= pull;
    });
  }
  // B = k [n n^T + (1 - l0/l) (1 - n n^T)]: positive definite where it is taut.
  template <class F>
  static void for_each_element(const Configuration& at, Tangent, const F& visit) {
    static constexpr std::array<double, 2> weights = {1.0, -1.0};
    for_each_taut(at, [&](const Cable& cable, const Vec3& x_ij) {
      const double k = cable.stiffness;
      const Mat3 along = x_ij * x_ij.transpose() / x_ij.squaredNorm();
      const Mat3 across = Mat3::Identity() - along;
      const double turn = 1.0 - cable.rest_length / x_ij.norm();
      visit(Element{cable.ends, weights, k * along + k * turn * across, k});
    });
  }

 private:
  template <class F>
  static void for_each_taut(const Configuration& at, const F& f) {
    for (const Cable& cable : at.model.cables) {
      const Vec3 x_ij = at.x[uz(cable.ends[1])] - at.x[uz(cable.ends[0])];
      if (x_ij.norm() > cable.rest_length) f(cable, x_ij);
    }
  }
};

}  // namespace sinew
