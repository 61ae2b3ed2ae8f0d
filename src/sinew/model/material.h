// The material of a tissue region and the law of its springs.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace sinew {

// The laws that give springs their constants (docs/methods/springs.md).
enum class Law {
  uniform,    // the same k and c for every spring
  lloyd,      // Lloyd, Szekely, Harders 2007: from Young's modulus
  vangelder,  // Van Gelder 1998: from Young's modulus
  // From here on the material constants determine the whole behaviour:
  neo_hookean,  // constant springs of rest length zero and volume (docs/methods/neo-hookean.md)
  calibrated,   // vangelder's springs and node volume, scaled to match E and nu on this mesh
};

// The cells whose volume an energy keeps (docs/methods/volume.md).
enum class Volume {
  by_law,  // node for neo-hookean and calibrated, tet for neo-hookean with nu < 0, none for the
           // others
  none,    // no volume is kept
  tet,     // every tet's
  node,    // every node's share of its tets, separately for each region
};

// The length in Lloyd's formula.
enum class LloydLength {
  tet,   // edge of the regular tet of the tet's volume, (6 sqrt(2) V)^(1/3)
  edge,  // the edge's own rest length
};

// The damping of the laws with a Young's modulus.
enum class Damping {
  ratio,      // c = 2 zeta sqrt(k m_red), zeta = damping_ratio
  published,  // d = 2 sqrt(k (m_i + m_j)) / l0, the number of the paper regardless of its unit
  material,   // none: the material's viscosity instead (forces/viscosity.h)
};

inline constexpr double no_limit = std::numeric_limits<double>::infinity();

struct Material {
  Law law = Law::neo_hookean;
  double density = 1060.0;        // [kg/m3] > 0
  double young = 15e3;            // [Pa] > 0; all laws but uniform
  double poisson = 0.45;          // [-] in (-1, 0.5)
  double spring_stiffness = 2e5;  // [N/m] > 0; uniform
  double spring_damping = 3e3;    // [N s/m] >= 0; uniform
  LloydLength length = LloydLength::tet;
  Damping damping = Damping::ratio;
  double damping_ratio = 0.1;  // [-] >= 0; damping = ratio, material
  double viscosity = 0.0;      // [Pa s] >= 0 in shear, in addition to that of damping; all laws
  double drag = 0.0;           // [1/s] >= 0; force -drag m v on every node
  double stretch_limit = no_limit;   // tau_s [-] > 0: |x_ij| <= (1 + tau_s) l0
  double compress_limit = no_limit;  // tau_c [-] in (0, 1]: |x_ij| >= (1 - tau_c) l0
  double beta = -1.0;                // [-] in [0, 1]; neo-hookean: share of the tets' own
                                     // gradients; negative: from poisson
  Volume volume = Volume::by_law;
  double volume_stiffness = -1.0;  // kappa [Pa] of the cells; negative: from young and poisson
  double volume_limit = no_limit;  // [-] > 0: largest |J - 1| of a node cell after a step
  double spring_scale = 1.0;  // [-] > 0, factor on the stiffness of lloyd's and vangelder's springs
};

// Lame's constants: mu = E / (2 (1 + nu)), lambda = E nu / ((1 + nu)(1 - 2 nu)) [Pa].
inline double shear_modulus(double young, double poisson) {
  return young / (2.0 * (1.0 + poisson));
}
inline double lame_lambda(double young, double poisson) {
  return young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
}

// The speed of pressure waves [m/s]: sqrt((lambda + 2 mu) / density), of nu = 0.499 at most.
inline double pressure_wave_speed(const Material& m) {
  const double nu = std::min(m.poisson, 0.499);
  return std::sqrt((lame_lambda(m.young, nu) + 2.0 * shear_modulus(m.young, nu)) / m.density);
}

// The volume cells of a material, with `by_law` resolved.
inline Volume volume_cells(const Material& m) {
  if (m.volume != Volume::by_law) return m.volume;
  if (m.law == Law::neo_hookean && m.poisson < 0.0) return Volume::tet;
  return m.law == Law::neo_hookean || m.law == Law::calibrated ? Volume::node : Volume::none;
}

// The share of the tets' own gradients in the network. Smoothed gradients alone do not resist modes
// that bend the tets around every edge against each other. The volume energy resists them; the
// weaker it is (small nu), the more of the tets' own gradients is needed: measured on 400 meshes
// with slivers, docs/methods/neo-hookean.md. Below nu = 0 nothing locks and the law is the plain
// linear tet.
inline double network_beta(const Material& m) {
  if (m.beta >= 0.0) return m.beta;
  if (m.poisson < 0.0) return 1.0;
  return m.poisson < 0.2 ? 0.1 - 0.4 * m.poisson : 0.02;
}

// kappa [Pa] of the volume energy. The network law needs lambda + mu (Smith, de Goes, Kim 2018). An
// isotropic network of classic springs has lambda = mu by itself and needs lambda - mu.
inline double volume_stiffness(const Material& m) {
  if (m.volume_stiffness >= 0.0) return m.volume_stiffness;
  const double mu = shear_modulus(m.young, m.poisson);
  const double lambda = lame_lambda(m.young, m.poisson);
  if (m.law == Law::neo_hookean) return lambda + mu;
  return lambda > mu ? lambda - mu : 0.0;
}

}  // namespace sinew
