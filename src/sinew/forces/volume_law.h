// The volume of a tet, its gradient and its second derivative, as pure functions on plain values:
// used by the loops in volume.cpp and by the tests.
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

// The change of that gradient, to first order, when the corners move by u: e_a changes by
// d_a = u_a - u_0. [m2 per unit of u]
inline Corners volume_gradient_change(const Vec3& e1, const Vec3& e2, const Vec3& e3,
                                      const Vec3& d1, const Vec3& d2, const Vec3& d3) {
  const Vec3 g1 = (d2.cross(e3) + e2.cross(d3)) / 6.0;
  const Vec3 g2 = (d3.cross(e1) + e3.cross(d1)) / 6.0;
  const Vec3 g3 = (d1.cross(e2) + e1.cross(d2)) / 6.0;
  return {-(g1 + g2 + g3), g1, g2, g3};
}

// --- the guard: a one-sided energy that rights tets about to turn inside out ---
//
//   dW/dv = -40 mu ((t - r)^2 - min(r, 0)^2)  for r = v/V below t = 0.4, else 0
//
// for tets that do not keep their own volume by an energy of theirs. A tet can invert inside a node
// cell whose own volume is kept; only the shear stiffness of its surroundings resists, so that mu
// is the guard's measure. It acts on no tet that keeps more than the share t of its volume, sets in
// softly, and is stiff only near 0; below 0 its stiffness stays that of 0.
// (The clamped bar W(k), E = 15 kPa, nu = 0.3: 8 of 1,280 tets are inverted without it, and 20 of
// 10,240 with one of a fifth of this strength; none with it.)
inline constexpr double guard_threshold = 0.4;
inline constexpr double guard_factor = 40.0;
inline constexpr double guard_margin = 0.1;  // what v/V may lose within a step
// Below this v/V the guard acts or may act within a step.
inline constexpr double low_ratio = guard_threshold + guard_margin;

// Its part of the tet's pressure, dW/dv [Pa] <= 0. ratio = v / V [-], mu [Pa].
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

// V d2W/dv2 [Pa]; never grows with ratio.
inline double guard_stiffness(double ratio, double mu) {
  return 2.0 * guard_factor * mu * std::max(0.0, guard_threshold - std::max(ratio, 0.0));
}

}  // namespace sinew
