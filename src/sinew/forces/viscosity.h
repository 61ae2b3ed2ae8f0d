// Viscosity of the material: Kelvin-Voigt's dashpot beside the elastic spring, per tet, so that it
// means the same on every mesh. docs/methods/viscosity.md.
#pragma once

#include <span>
#include <vector>

#include "sinew/forces/workspace.h"
#include "sinew/mesh/tet_mesh.h"
#include "sinew/model/model.h"

namespace sinew {

// Shear viscosity eta [Pa s] of a material in a body whose longest side is `length` [m]: its own,
// and under Damping::material that which gives the standing shear wave of half a wave along that
// side the damping ratio zeta,
//   eta = 2 zeta mu / omega_0,   omega_0 = (pi / length) sqrt(mu / rho).
double material_viscosity(const Material& material, double length);

// Longest side [m] of the box around the nodes along the axes that `rotation` turns x, y and z to.
double longest_side(std::span<const Vec3> nodes, const Eigen::Quaterniond& rotation);

// Edges of a tet from its corner 0, as columns: x_1 - x_0, x_2 - x_0, x_3 - x_0 [m]; or the same of
// velocities.
inline Mat3 tet_edges(std::span<const Vec3> x, const Tet& t) {
  Mat3 edges;
  const Vec3& x0 = x[uz(t[0])];
  edges << x[uz(t[1])] - x0, x[uz(t[2])] - x0, x[uz(t[3])] - x0;
  return edges;
}

// What the viscosity of a tet does to its corners.
struct ViscousPull {
  Mat3 force = Mat3::Zero();  // columns: on corners 1, 2 and 3 [N]; corner 0 gets minus their sum
  double heat = 0.0;          // 2 eta V |dE/dt|^2 [W]
};

// The second Piola-Kirchhoff stress 2 eta dE/dt, E = (F^T F - 1) / 2 Green's strain:
//
//   dE/dt = B^T A B,   A = sym(X^T dX/dt),   X the edges, B the inverse of the rest edges,
//   force = -dD/dv = -2 eta V X (M A M),     D = eta V |dE/dt|^2,   M = B B^T, M_ab = G_a . G_b
//
// A is half the rate of the edges' dot products: a rigid motion has none, and no tet, flat or
// inside out, is singular. X M A M X^T is symmetric: no torque. metric: M [1/m2]; weight: eta V
// [Pa s m3].
inline ViscousPull viscous_pull(const Mat3& edges, const Mat3& edge_rates, const Mat3& metric,
                                double weight) {
  const Mat3 turning = edges.transpose() * edge_rates;
  const Mat3 rate = 0.5 * (turning + turning.transpose());
  const Mat3 stress = 2.0 * weight * (metric * rate * metric);
  return {-(edges * stress), rate.cwiseProduct(stress).sum()};
}

// Appends tet_viscosity and tet_metric of a body's tets, the model's last ones; nothing where no
// material so far is viscous. length: longest side of the body [m].
void add_viscosity(Model& model, const Body& body, const std::vector<Material>& materials,
                   double length);

// Fills workspace.viscous_force with what the viscosity pulls the corners with at positions x and
// velocities v. Returns the power [W] that it turns into heat. For models with viscosity only.
double compute_viscous_forces(const Model& model, std::span<const Vec3> x, std::span<const Vec3> v,
                              Workspace& workspace);

// That power alone, v . C v [W]; 0 without viscosity.
double viscous_power(const Model& model, std::span<const Vec3> x, std::span<const Vec3> v);

// Upper bound of the sum of |C_ij| over a row, for every node [N s/m] (nodes), added to `sums`.
void add_viscous_row_sums(const Model& model, std::span<const Vec3> x, std::span<double> sums);

// Sum, for a node in the fixed order of its tets, of what workspace.viscous_force holds.
inline Vec3 gather_viscous(const Model& model, const Workspace& workspace, Index node) {
  Vec3 sum = Vec3::Zero();
  const auto n = uz(node);
  for (Index k = model.tet_start[n]; k < model.tet_start[n + 1]; ++k) {
    const Index corner = model.node_tet[uz(k)];
    const Mat3& force = workspace.viscous_force[uz(corner / 4)];
    if (corner % 4 > 0) {
      sum += force.col(corner % 4 - 1);
    } else {
      sum -= force.rowwise().sum();
    }
  }
  return sum;
}

}  // namespace sinew
