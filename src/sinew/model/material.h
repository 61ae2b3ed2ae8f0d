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
  by_law,  // node for neo-hookean and calibrated, none for the others
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

// The share of the tets' own gradients in the network. Edge cells alone are stable, but modes that
// bend the tets around every edge against each other are then so soft that bodies in contact
// chatter in implicit steps. A fiftieth costs 0.1 % of accuracy (docs/methods/neo-hookean.md).
inline constexpr double default_beta = 0.02;

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
  double beta = default_beta;        // [-] in [0, 1]; neo-hookean: share of the tets' own
                                     // gradients
  Volume volume = Volume::by_law;
  double volume_stiffness = -1.0;  // kappa [Pa] of the cells; negative: from young and poisson
  double volume_limit = no_limit;  // [-] > 0: largest |J - 1| of a node cell after a step
  double tear_energy = no_limit;   // Gc [J/m2] > 0: a crack advances where it releases so much
  double tear_strain = no_limit;   // [-] > 0: tissue tears where its largest strain, as a mean
  double tear_length = 0.0;        // over this length [m], reaches so much; 0: of the body's size
  double spring_scale = 1.0;  // [-] > 0, factor on the stiffness of lloyd's and vangelder's springs
};

inline bool tears(const Material& m) {
  return m.tear_energy < no_limit || m.tear_strain < no_limit;
}

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
  return m.law == Law::neo_hookean || m.law == Law::calibrated ? Volume::node : Volume::none;
}

// kappa_e [Pa] of the network law's edge cells and tets, the part of its volume stiffness that acts
// with the shear. With mu the energy of a cell is mu |eps|^2 at small strains, and its volume cells
// hold the rest, lambda. Below nu = 0 that rest would be negative; with mu/3 the energy of a cell
// is mu |dev eps|^2, and the rest is the bulk modulus.
inline double shear_bulk(const Material& m) {
  const double mu = shear_modulus(m.young, m.poisson);
  return m.poisson < 0.0 ? mu / 3.0 : mu;
}

// kappa [Pa] of the volume energy of tets or node cells. The network law needs lambda + mu (Smith,
// de Goes, Kim 2018), less what acts with the shear. An isotropic network of classic springs has
// lambda = mu by itself and needs lambda - mu.
inline double volume_stiffness(const Material& m) {
  if (m.volume_stiffness >= 0.0) return m.volume_stiffness;
  const double mu = shear_modulus(m.young, m.poisson);
  const double lambda = lame_lambda(m.young, m.poisson);
  if (m.law == Law::neo_hookean) return lambda + mu - shear_bulk(m);
  return lambda > mu ? lambda - mu : 0.0;
}

}  // namespace sinew
