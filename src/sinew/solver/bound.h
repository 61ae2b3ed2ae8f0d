// Constraints on a quantity as energies with multipliers, as pure functions on plain values: the
// augmented Lagrangian (Hestenes 1969, Powell 1969; for inequalities Rockafellar 1973).
// docs/methods/constraints.md.
#pragma once

#include <algorithm>

#include "sinew/base/vec.h"

namespace sinew {

// The relative tolerance of the normal forces that bound friction.
inline constexpr double friction_tolerance = 2e-3;

// A quantity q with the constraint low <= q <= high, a stiffness k > 0 and the multiplier p of the
// pass before:
//
//   s(q) = k (t - clamp(t, low, high)),   t = q + p / k          the force that pulls q back
//   W(q) = (s^2 - p^2) / (2 k)                                   dW/dq = s
//
// If s(q) = p, the constraint holds exactly, for any k: s > 0 only at q = high, s < 0 only at low.
inline double bound_force(double q, double low, double high, double k, double p) {
  const double t = q + p / k;
  return k * (t - std::clamp(t, low, high));
}
inline double bound_energy(double q, double low, double high, double k, double p) {
  const double s = bound_force(q, low, high, k, p);
  return 0.5 * (s * s - p * p) / k;
}
// d2W/dq2.
inline double bound_stiffness(double q, double low, double high, double k, double p) {
  return bound_force(q, low, high, k, p) != 0.0 ? k : 0.0;
}

// Coulomb friction for a slip u along the plane: at most r = mu times the normal force, with a
// stiffness k and the multiplier p of the pass before:
//
//   s(u) = t min(1, r / |t|),   t = p + k u
//   W(u) = (|t|^2 / 2  or, if |t| > r,  r |t| - r^2 / 2) / k - |p|^2 / (2 k)        dW/du = s
//
// If s(u) = p, the node sticks (u = 0, |s| <= r) or slides (s = r u / |u|); there is no creep at
// low speed.
inline Vec3 friction_force(const Vec3& u, double r, double k, const Vec3& p) {
  const Vec3 t = p + k * u;
  const double size = t.norm();
  return size <= r ? t : Vec3((r / size) * t);
}
inline double friction_energy(const Vec3& u, double r, double k, const Vec3& p) {
  const double size = (p + k * u).norm();
  const double t = size <= r ? 0.5 * size * size : r * (size - 0.5 * r);
  return (t - 0.5 * p.squaredNorm()) / k;
}
// The second derivative as a block on displacements; only their part along the plane with the
// normal n counts.
inline Mat3 friction_stiffness(const Vec3& u, double r, double k, const Vec3& p, const Vec3& n) {
  const Mat3 plane = Mat3::Identity() - n * n.transpose();
  const Vec3 t = p + k * u;
  const double size = t.norm();
  if (size <= r) return k * plane;
  const Vec3 along = t / size;
  return (k * r / size) * (plane - along * along.transpose());
}

}  // namespace sinew
