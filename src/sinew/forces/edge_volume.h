// The volume energy of the network law's edge cells,
//
//   W(x) = sum_e V_e [ -mu_e (J_e - 1) + kappa_e/2 (J_e - 1)^2 ],   J_e = det F_e,
//
// on the same mean gradients F_e as the network's springs, so that
//   mu_e/2 (|F_e|^2 - 3) - mu_e (J_e - 1) + kappa_e/2 (J_e - 1)^2
// is the stable neo-Hookean energy of each cell (Smith, de Goes, Kim 2018): at small strains
//   mu_e |eps|^2 + (kappa_e - mu_e)/2 tr(eps)^2 >= 0 for kappa_e >= mu_e / 3.
// docs/methods/neo-hookean.md.
#pragma once

#include <span>
#include <vector>

#include "sinew/forces/gradient_cells.h"
#include "sinew/model/model.h"

namespace sinew {

// The derivative of det F: its columns are the cross products of the other two columns of F.
inline Mat3 cofactor(const Mat3& F) {
  const Vec3 x = F.col(0), y = F.col(1), z = F.col(2);
  Mat3 C;
  C << y.cross(z), z.cross(x), x.cross(y);
  return C;
}

// The first-order change of the cofactor if F changes by dF.
inline Mat3 cofactor_change(const Mat3& F, const Mat3& dF) {
  Mat3 C;
  C.col(0) = dF.col(1).cross(F.col(2)) + F.col(1).cross(dF.col(2));
  C.col(1) = dF.col(2).cross(F.col(0)) + F.col(2).cross(dF.col(0));
  C.col(2) = dF.col(0).cross(F.col(1)) + F.col(0).cross(dF.col(1));
  return C;
}

// s_e = dW/dJ / V = kappa (J - 1) - mu [Pa].
inline double edge_pressure(double J, double shear, double bulk) {
  return bulk * (J - 1.0) - shear;
}

// The edge cells at given positions; empty if the model has none.
struct EdgeState {
  std::vector<Mat3> deformation;  // F_e [-] (edge cells)
  std::vector<Mat3> stress;       // V_e s_e cof F_e [J] (edge cells)
};

// The arrays of `state` become those of the result, so that a second call allocates nothing.
void compute_edge_state(const Model& model, std::span<const Vec3> x, EdgeState& state);

// W [J]: zero at rest.
double edge_volume_energy(const Model& model, std::span<const Vec3> x);

// The change of V_e s_e cof F_e by a displacement u, to first order [J] (edge cells).
void compute_edge_stress_change(const Model& model, const EdgeState& state, std::span<const Vec3> u,
                                std::vector<Mat3>& change);

// The blocks of an edge cell's second derivative,
//   K_ab = V (kappa (C g_a)(C g_b)^T - s [F (g_a x g_b)]_x),
// since J = sum_abc x_a . (x_b x x_c) g_a . (g_b x g_c) / 6.
struct EdgeTangent {
  EdgeTangent(const Model& model, const EdgeState& state, Index cell);
  Mat3 block(const Vec3& g_a, const Vec3& g_b) const;

  Mat3 F, C;
  double bulk;      // V kappa [J]
  double pressure;  // V s [J]
};

// Adds to rows[i] an upper bound of sum_j |K_ij| of this energy [N/m] (nodes).
void add_edge_row_sums(const Model& model, std::span<const Vec3> x, std::span<double> rows);

}  // namespace sinew
