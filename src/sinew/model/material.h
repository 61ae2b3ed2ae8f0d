// What a region of tissue is made of and how its springs come from it.
#pragma once

#include <limits>

namespace sinew {

// How springs get their constants (docs/methods/springs.md).
enum class Law {
  uniform,    // the same k and c for every spring
  lloyd,      // Lloyd, Szekely, Harders 2007: from Young's modulus
  vangelder,  // Van Gelder 1998: from Young's modulus
};

// Which length enters Lloyd's formula.
enum class LloydLength {
  tet,   // edge of the regular tet of the tet's volume, (6 sqrt(2) V)^(1/3)
  edge,  // the edge's own rest length
};

// How the laws with a Young's modulus get their dashpots.
enum class Damping {
  ratio,      // c = 2 zeta sqrt(k m_red), zeta = damping_ratio
  published,  // d = 2 sqrt(k (m_i + m_j)) / l0, the number of the paper, whatever its unit
};

inline constexpr double no_limit = std::numeric_limits<double>::infinity();

struct Material {
  Law law = Law::lloyd;
  double density = 1060.0;        // [kg/m3] > 0
  double young = 15e3;            // [Pa] > 0; lloyd and vangelder
  double poisson = 0.45;          // [-] in (-1, 0.5); kept for the laws that can honour it
  double spring_stiffness = 2e5;  // [N/m] > 0; uniform
  double spring_damping = 3e3;    // [N s/m] >= 0; uniform
  LloydLength length = LloydLength::tet;
  Damping damping = Damping::ratio;
  double damping_ratio = 0.1;        // [-] >= 0; damping = ratio
  double drag = 0.0;                 // [1/s] >= 0; force -drag m v on every node
  double stretch_limit = no_limit;   // tau_s [-] > 0: |x_ij| <= (1 + tau_s) l0
  double compress_limit = no_limit;  // tau_c [-] in (0, 1]: |x_ij| >= (1 - tau_c) l0
};

}  // namespace sinew
