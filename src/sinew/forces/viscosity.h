// Viscosity of the material: a Kelvin-Voigt dashpot parallel to the elastic spring, with the same
// effect on every mesh. docs/methods/viscosity.md.
//
// It acts on the cells of the network law's shear energy with the same shares, beta on each tet and
// 1 - beta on the tets around each edge (edge_cells.h). So every oscillation that keeps the volume
// is damped in proportion to its elastic energy. On single tets, which lock, a bar of 3 cells would
// be damped 40 % too strongly in torsion.
#pragma once

#include <span>
#include <vector>

#include "sinew/mesh/tet_mesh.h"
#include "sinew/model/model.h"

namespace sinew {

// Shear viscosity eta [Pa s] of a material in a body whose longest side is `length` [m]: its own
// viscosity, plus under Damping::material the one that gives a standing shear wave (half a wave
// along that side) the damping ratio zeta,
//   eta = 2 zeta mu / omega_0,   omega_0 = (pi / length) sqrt(mu / rho).
double material_viscosity(const Material& material, double length);

// Longest side [m] of the box around the nodes, along the axes x, y and z rotated by `rotation`.
double longest_side(std::span<const Vec3> nodes, const Eigen::Quaterniond& rotation);

struct ViscousStress {
  Mat3 stress = Mat3::Zero();  // V times the first Piola-Kirchhoff stress [J]
  double heat = 0.0;           // 2 eta V |dE/dt|^2 [W]
};

// The second Piola-Kirchhoff stress is 2 eta dE/dt, with Green's strain E = (F^T F - 1) / 2:
//
//   dE/dt = sym(F^T dF/dt),   P = 2 eta F dE/dt,   D = eta V |dE/dt|^2,
//   force on node a = -dD/dv_a = -V P g_a
//
// F = sum_a x_a g_a^T and dF/dt = sum_a v_a g_a^T with the cell's gradients g_a. For a rigid motion
// dE/dt is 0. P F^T is symmetric, so there is no net torque. Nothing is singular in a flat or
// inverted cell. weight: eta V [Pa s m3].
inline ViscousStress viscous_stress(const Mat3& F, const Mat3& F_rate, double weight) {
  const Mat3 turning = F.transpose() * F_rate;
  const Mat3 rate = 0.5 * (turning + turning.transpose());
  return {2.0 * weight * (F * rate), 2.0 * weight * rate.squaredNorm()};
}

// -dforce_a/dv_b of a cell, eta V [(g_a . g_b) F F^T + (F g_b)(F g_a)^T] [N s/m].
inline Mat3 viscous_block(const Mat3& F, const Vec3& g_a, const Vec3& g_b, double weight) {
  return weight * (g_a.dot(g_b) * (F * F.transpose()) + (F * g_b) * (F * g_a).transpose());
}

// Appends tet_viscosity and the cells of a body, the model's last one; nothing if no material so
// far is viscous. The mesh's nodes are the model's nodes from first_node on. tet_region: (tets) or
// empty; length: longest side of the body [m].
void add_viscosity(Model& model, const TetMesh& mesh, const std::vector<Material>& materials,
                   std::span<const int> tet_region, Index first_node, double length);

// Sets `force`, the viscous force on each node of each cell [N] (slots), from positions x and
// velocities v. Returns the power [W] that viscosity turns into heat.
double compute_viscous_forces(const Model& model, std::span<const Vec3> x, std::span<const Vec3> v,
                              std::vector<Vec3>& force);

// a . C b [W], C the matrix of the viscous forces at x; a = b = v: that power.
double viscous_power(const Model& model, std::span<const Vec3> x, std::span<const Vec3> a,
                     std::span<const Vec3> b);

// An upper bound of the row sum of |C_ij| for every node [N s/m] (nodes).
std::vector<double> viscous_row_sums(const Model& model, std::span<const Vec3> x);

// The sum of the viscous forces on a node over its cells, in their fixed order (slots). Only for
// models with viscosity.
inline Vec3 gather_viscous(const Model& model, const std::vector<Vec3>& force, Index node) {
  Vec3 sum = Vec3::Zero();
  const GradientCells& cells = model.viscous_cells;
  for (Index k = cells.node_start[uz(node)]; k < cells.node_start[uz(node) + 1]; ++k) {
    sum += force[uz(cells.node_slot[uz(k)])];
  }
  return sum;
}

}  // namespace sinew
