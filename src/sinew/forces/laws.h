// How springs get their constants from the material and the mesh: docs/methods/springs.md.
#pragma once

#include <cmath>
#include <numbers>

namespace sinew {

// Edge of the regular tet of volume V [m3]: l = (6 sqrt(2) V)^(1/3) [m].
inline double regular_edge(double volume) {
  return std::cbrt(6.0 * std::numbers::sqrt2 * volume);
}

// What one tet adds to the stiffness of its edge after Lloyd, Szekely and Harders 2007:
// (2 sqrt(2) / 25) l E. length [m], young [Pa]; returns [N/m].
inline double lloyd_stiffness(double length, double young) {
  return 2.0 * std::numbers::sqrt2 / 25.0 * length * young;
}

// What one tet adds to the stiffness of its edge after Van Gelder 1998: E V / l^2.
// volume [m3], edge length [m], young [Pa]; returns [N/m].
inline double vangelder_stiffness(double volume, double length, double young) {
  return young * volume / (length * length);
}

// Dashpot that damps the pair of masses by the share zeta of critical damping when it swings alone:
// c = 2 zeta sqrt(k m_red), m_red = m_i m_j / (m_i + m_j). [N s/m]
inline double ratio_damping(double zeta, double stiffness, double mass_i, double mass_j) {
  return 2.0 * zeta * std::sqrt(stiffness * (mass_i * mass_j / (mass_i + mass_j)));
}

// Dashpot as Lloyd, Szekely and Harders 2007 print it: 2 sqrt(k (m_i + m_j)) / l0. Its unit is
// kg/(m s); the number is taken as N s/m, as the published simulations do.
inline double published_damping(double stiffness, double mass_i, double mass_j, double length) {
  return 2.0 * std::sqrt(stiffness * (mass_i + mass_j)) / length;
}

}  // namespace sinew
