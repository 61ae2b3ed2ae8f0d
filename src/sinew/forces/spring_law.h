// The formula of a spring with a dashpot, as pure functions on plain values: used by the loops in
// springs.cpp and by the tests. Nealen et al. 2006, section 4.3.
#pragma once

#include <algorithm>
#include <cmath>

#include "sinew/base/vec.h"

namespace sinew {

// Force on end i; end j gets its negative.
//   f = k (|x_ij| - l0) x_ij / |x_ij| + c ((v_ij . x_ij) / (x_ij . x_ij)) x_ij
// x_ij = x_j - x_i [m], v_ij = v_j - v_i [m/s], k [N/m], l0 [m], c [N s/m]; returns [N].
// Ends that coincide have no direction: no force.
inline Vec3 spring_force(const Vec3& x_ij, const Vec3& v_ij, double k, double l0, double c) {
  const double length2 = x_ij.squaredNorm();
  if (length2 == 0.0) return Vec3::Zero();
  const double length = std::sqrt(length2);
  return (k * (length - l0) / length + c * v_ij.dot(x_ij) / length2) * x_ij;
}

// Stored energy k/2 (|x_ij| - l0)^2 [J].
inline double spring_energy(const Vec3& x_ij, double k, double l0) {
  const double extension = x_ij.norm() - l0;
  return 0.5 * k * extension * extension;
}

// Power that the dashpot turns into heat, c (v_ij . n)^2 [W].
inline double dashpot_power(const Vec3& x_ij, const Vec3& v_ij, double c) {
  const double length2 = x_ij.squaredNorm();
  if (length2 == 0.0) return 0.0;
  const double along = v_ij.dot(x_ij);
  return c * along * along / length2;
}

// Change of the force's negative when u_ij = u_j - u_i is added to x_ij, the Hessian's block times
// u_ij:  k [ (l0/l) n (n . u) + (1 - l0/l) u ].  With `only_stiffening`, the transverse part of a
// compressed spring, which is negative, is left out: what remains is positive semidefinite.
inline Vec3 spring_stiffness_times(const Vec3& x_ij, double k, double l0, const Vec3& u_ij,
                                   bool only_stiffening = false) {
  const double length2 = x_ij.squaredNorm();
  if (length2 == 0.0) return k * u_ij;
  double transverse = 1.0 - l0 / std::sqrt(length2);
  if (only_stiffening) transverse = std::max(0.0, transverse);
  const Vec3 along = (x_ij.dot(u_ij) / length2) * x_ij;
  return k * (along + transverse * (u_ij - along));
}

// Change of the dashpot's force with the velocity: c n (n . u).
inline Vec3 dashpot_times(const Vec3& x_ij, double c, const Vec3& u_ij) {
  const double length2 = x_ij.squaredNorm();
  if (length2 == 0.0) return Vec3::Zero();
  return (c * x_ij.dot(u_ij) / length2) * x_ij;
}

}  // namespace sinew
