// The volume of a tet, its gradient and its second derivative, as pure functions on plain values;
// volume.cpp and the tests use them.
#pragma once

#include <algorithm>
#include <array>

#include "sinew/base/vec.h"

namespace sinew {

using Corners = std::array<Vec3, 4>;  // one vector per corner of a tet

// dv/dx of the corners [m2], v the signed volume: e2 x e3 / 6, e3 x e1 / 6, e1 x e2 / 6 for the
// corners 1, 2, 3 with e_a = x_a - x_0, and minus their sum for corner 0.
inline Corners volume_gradient(const Vec3& e1, const Vec3& e2, const Vec3& e3) {
  const Vec3 g1 = e2.cross(e3) / 6.0;
  const Vec3 g2 = e3.cross(e1) / 6.0;
  const Vec3 g3 = e1.cross(e2) / 6.0;
  return {-(g1 + g2 + g3), g1, g2, g3};
}

// The first-order change of that gradient if the corners move by u: e_a changes by d_a = u_a - u_0.
// [m2 per unit of u]
inline Corners volume_gradient_change(const Vec3& e1, const Vec3& e2, const Vec3& e3,
                                      const Vec3& d1, const Vec3& d2, const Vec3& d3) {
  const Vec3 g1 = (d2.cross(e3) + e2.cross(d3)) / 6.0;
  const Vec3 g2 = (d3.cross(e1) + e3.cross(d1)) / 6.0;
  const Vec3 g3 = (d1.cross(e2) + e1.cross(d2)) / 6.0;
  return {-(g1 + g2 + g3), g1, g2, g3};
}

// --- the guard: a one-sided energy that recovers tets close to inversion ---
//
//   dW/dv = -40 mu ((t - r)^2 - min(r, 0)^2)  for r = v/V below t = 0.4, else 0
//
// for tets without a volume energy of their own. A tet can invert inside a node cell that keeps its
// volume. Only the shear stiffness around it resists, so the guard is proportional to mu. It does
// not act on tets that keep more than the share t of their volume, starts softly and is stiff only
// near 0; below 0 its stiffness stays the same as at 0.
// (The clamped bar W(k), E = 15 kPa, nu = 0.3: 8 of 1,280 tets are inverted without it, and 20 of
// 10,240 with a fifth of this strength; none with it.)
inline constexpr double guard_threshold = 0.4;
inline constexpr double guard_factor = 40.0;
inline constexpr double guard_margin = 0.1;  // largest decrease of v/V in a step
// Below this v/V the guard acts or may act within a step.
inline constexpr double low_ratio = guard_threshold + guard_margin;

// The guard's part of the tet's pressure, dW/dv [Pa] <= 0. ratio = v / V [-], mu [Pa].
inline double guard_pressure(double ratio, double mu) {
  const double lack = std::max(0.0, guard_threshold - ratio);
  const double below = std::min(ratio, 0.0);
  return -guard_factor * mu * (lack * lack - below * below);
}

// W / V [Pa].
inline double guard_energy(double ratio, double mu) {
  const double lack = std::max(0.0, guard_threshold - ratio);
  const double below = std::min(ratio, 0.0);
  return guard_factor / 3.0 * mu * (lack * lack * lack + below * below * below);
}

// V d2W/dv2 [Pa]; never increases with ratio.
inline double guard_stiffness(double ratio, double mu) {
  return 2.0 * guard_factor * mu * std::max(0.0, guard_threshold - std::max(ratio, 0.0));
}

}  // namespace sinew
