// The volume of a tet, its gradient and its second derivative, as pure functions on plain values:
// used by the loops in volume.cpp and by the tests.
#pragma once

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
//   W = V g/2 max(0, guard_threshold - v/V)^2
//
// A tet can invert inside a node cell whose own volume is kept. The guard acts on that tet alone,
// and on no tet that keeps more than the threshold's share of its volume, so that it costs no
// accuracy where there is nothing to right.
inline constexpr double guard_threshold = 0.2;

// Its part of the tet's pressure, dW/dv [Pa] <= 0. ratio = v / V [-], guard = g [Pa].
inline double guard_pressure(double ratio, double guard) {
  return ratio < guard_threshold ? guard * (ratio - guard_threshold) : 0.0;
}

// W / V [Pa].
inline double guard_energy(double ratio, double guard) {
  const double lack = ratio < guard_threshold ? guard_threshold - ratio : 0.0;
  return 0.5 * guard * lack * lack;
}

}  // namespace sinew
