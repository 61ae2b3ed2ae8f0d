// The formula of a spring with a dashpot, as pure functions on plain values; springs.cpp and the
// tests use them. Nealen et al. 2006, section 4.3.
#pragma once

#include <algorithm>
#include <cmath>

#include "sinew/base/vec.h"

namespace sinew {

// The force of a spring on its ends.
struct SpringForce {
  Vec3 force = Vec3::Zero();  // on end i [N]; end j gets its negative
  double heat = 0.0;          // power that the dashpot turns into heat, c (v_ij . n)^2 [W]
};

//   f = k (|x_ij| - l0) x_ij / |x_ij| + c ((v_ij . x_ij) / (x_ij . x_ij)) x_ij
// x_ij = x_j - x_i [m], v_ij = v_j - v_i [m/s], k [N/m], l0 [m], c [N s/m].
// Ends that coincide have no direction: no force.
inline SpringForce spring_force(const Vec3& x_ij, const Vec3& v_ij, double k, double l0, double c) {
  const double length2 = x_ij.squaredNorm();
  if (length2 == 0.0) return {};
  const double inverse2 = 1.0 / length2;  // one division: it costs more than the rest
  const double length = std::sqrt(length2);
  const double along = v_ij.dot(x_ij);
  const double dashpot = c * along * inverse2;
  return {(k * (length - l0) * length * inverse2 + dashpot) * x_ij, dashpot * along};
}

// The same for a dashpot alone: no square root.
inline SpringForce dashpot_force(const Vec3& x_ij, const Vec3& v_ij, double c) {
  const double length2 = x_ij.squaredNorm();
  if (length2 == 0.0) return {};
  const double along = v_ij.dot(x_ij);
  const double dashpot = c * along / length2;
  return {dashpot * x_ij, dashpot * along};
}

// Stored energy k/2 (|x_ij| - l0)^2 [J].
inline double spring_energy(const Vec3& x_ij, double k, double l0) {
  const double extension = x_ij.norm() - l0;
  return 0.5 * k * extension * extension;
}

// The negative change of the force if u_ij = u_j - u_i is added to x_ij, the Hessian's block times
// u_ij:  k [ (l0/l) n (n . u) + (1 - l0/l) u ].  With `only_stiffening` the transverse part of a
// compressed spring, which is negative, is left out: the result is positive semidefinite.
inline Vec3 spring_stiffness_times(const Vec3& x_ij, double k, double l0, const Vec3& u_ij,
                                   bool only_stiffening = false) {
  const double length2 = x_ij.squaredNorm();
  if (length2 == 0.0) return k * u_ij;
  double transverse = 1.0 - l0 / std::sqrt(length2);
  if (only_stiffening) transverse = std::max(0.0, transverse);
  const Vec3 along = (x_ij.dot(u_ij) / length2) * x_ij;
  return k * (along + transverse * (u_ij - along));
}

// The change of the dashpot's force with the velocity: c n (n . u). Ends that coincide may separate
// in any direction: c u.
inline Vec3 dashpot_times(const Vec3& x_ij, double c, const Vec3& u_ij) {
  const double length2 = x_ij.squaredNorm();
  if (length2 == 0.0) return c * u_ij;
  return (c * x_ij.dot(u_ij) / length2) * x_ij;
}

// Both as matrices that multiply u_ij.
inline Mat3 spring_stiffness_block(const Vec3& x_ij, double k, double l0) {
  const double length2 = x_ij.squaredNorm();
  if (length2 == 0.0) return k * Mat3::Identity();
  const double transverse = 1.0 - l0 / std::sqrt(length2);
  return k * transverse * Mat3::Identity() +
         (k * (1.0 - transverse) / length2 * x_ij) * x_ij.transpose();
}
inline Mat3 dashpot_block(const Vec3& x_ij, double c) {
  const double length2 = x_ij.squaredNorm();
  if (length2 == 0.0) return c * Mat3::Identity();
  return (c / length2 * x_ij) * x_ij.transpose();
}

}  // namespace sinew
