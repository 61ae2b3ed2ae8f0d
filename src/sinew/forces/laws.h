// The constants of springs from the material and the mesh: docs/methods/springs.md.
#pragma once

#include <cmath>
#include <numbers>

namespace sinew {

// The contribution of one tet to the stiffness of its edge, after Lloyd, Szekely and Harders 2007:
// (2 sqrt(2) / 25) l E. length [m], young [Pa]; returns [N/m].
inline double lloyd_stiffness(double length, double young) {
  return 2.0 * std::numbers::sqrt2 / 25.0 * length * young;
}

// The contribution of one tet to the stiffness of its edge, after Van Gelder 1998: E V / l^2.
// volume [m3], edge length [m], young [Pa]; returns [N/m].
inline double vangelder_stiffness(double volume, double length, double young) {
  return young * volume / (length * length);
}

// The dashpot with the damping ratio zeta for the oscillation of the two masses alone: c = 2 zeta
// sqrt(k m_red), m_red = m_i m_j / (m_i + m_j). [N s/m]
inline double ratio_damping(double zeta, double stiffness, double mass_i, double mass_j) {
  return 2.0 * zeta * std::sqrt(stiffness * (mass_i * mass_j / (mass_i + mass_j)));
}

// The dashpot as printed by Lloyd, Szekely and Harders 2007: 2 sqrt(k (m_i + m_j)) / l0. Its unit
// is kg/(m s); the number is taken as N s/m, as in the published simulations.
inline double published_damping(double stiffness, double mass_i, double mass_j, double length) {
  return 2.0 * std::sqrt(stiffness * (mass_i + mass_j)) / length;
}

}  // namespace sinew
