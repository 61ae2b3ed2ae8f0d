// Volume terms: what keeps the volume of tets and node cells, and the push of the network law.
//
//   W(x) = sum_t [ -mu_t (v_t - V_t) + V_t kappa_t/2 (v_t/V_t - 1)^2 + guard ]
//        + sum_c V_c kappa_c/2 (J_c - 1)^2,   J_c = (sum of its shares of v_t) / V_c
//
// so that the force on node i is -sum_{t at i} s_t dv_t/dx_i with the tet's pressure
//   s_t = -mu_t + kappa_t (v_t/V_t - 1) + (its cells' kappa_c (J_c - 1), by their shares) + guard.
// docs/methods/volume.md.
#pragma once

#include <span>
#include <vector>

#include "sinew/forces/workspace.h"
#include "sinew/mesh/tet_mesh.h"
#include "sinew/model/model.h"

namespace sinew {

// Appends the volume terms of a body's tets, the model's last ones: tet_shear, tet_bulk and the
// node cells, split by region.
void add_volume_terms(Model& model, const Body& body, const std::vector<Material>& materials);

// The volume of every node cell [m3] when each of the tets is cut in equal quarters: a tet's shares
// in the cells of its corners (Model::cell_share) are in proportion to it.
std::vector<double> quarter_volumes_of_cells(const Model& model, Range tets);

// Derives the lists cell -> tets and node -> tets; called once, by finish().
void finish_volume_terms(Model& model);

// sum_t p_t dv_t/dx_i over the node's tets in their fixed order, p (tets).
inline Vec3 press_tets(const Model& model, const Workspace& workspace, std::span<const double> p,
                       Index node) {
  Vec3 sum = Vec3::Zero();
  const auto n = uz(node);
  for (Index k = model.tet_start[n]; k < model.tet_start[n + 1]; ++k) {
    const auto corner = uz(model.node_tet[uz(k)]);
    sum += p[corner / 4] * workspace.tet_gradient[corner / 4][corner % 4];
  }
  return sum;
}

// Fills workspace.tet_volume, tet_gradient and tet_pressure (s_t) at positions x: all that the
// forces are made of (push_of_tets), and that the products below expect.
void compute_volume_pressures(const Model& model, std::span<const Vec3> x, Workspace& workspace);

// Only tet_volume and tet_pressure: what energies and measures need.
void compute_pressures(const Model& model, std::span<const Vec3> x, Workspace& workspace);

// Only tet_volume and tet_gradient, and of these tets alone.
void compute_tet_geometry(const Model& model, std::span<const Vec3> x, std::span<const Index> tets,
                          Workspace& workspace);

// -sum_t s_t dv_t/dx_i over the node's tets in their fixed order: the force on it [N].
inline Vec3 push_of_tets(const Model& model, const Workspace& workspace, Index node) {
  return -press_tets(model, workspace, workspace.tet_pressure, node);
}

// Pressure of every tet [Pa] (tets), > 0 where it is squeezed: minus the mean Kirchhoff stress,
//   p = -(mu |F|^2 / 3 + s v/V),   F the tet's deformation gradient,
// which at small strains is -K (v/V - 1) with the bulk modulus K. Of classic springs only what
// their volume energy does; empty where the model has no volume terms. Expects what
// compute_pressures leaves at x.
std::vector<double> measure_pressure(const Model& model, std::span<const Vec3> x,
                                     const Workspace& workspace);

// W [J]: zero at rest.
double volume_energy(const Model& model, std::span<const Vec3> x, Workspace& workspace);

// Fills workspace.tet_force with what a displacement u changes the corner forces by, to first
// order and with the sign of a force: -a H u. Expects what compute_volume_pressures leaves at x.
void compute_volume_force_change(const Model& model, std::span<const Vec3> x, double a,
                                 std::span<const Vec3> u, Workspace& workspace);

// --- the pieces of a projection on the cells' volumes (volume_limit.h) ---

// volume = current volume of every cell [m3] (cells). Leaves workspace.tet_gradient for the others.
void sum_cells(const Model& model, std::span<const Vec3> x, Workspace& workspace,
               std::span<double> volume);
// rate = what u changes those volumes by, to first order [m3] (cells).
void rate_cells(const Model& model, std::span<const Vec3> u, Workspace& workspace,
                std::span<double> rate);
// Fills workspace.tet_pressure_change so that press_tets gives the gradient of
// sum_c weight_c V_c(x).
void press_cells(const Model& model, std::span<const double> weight, Workspace& workspace);

// V d2W/dv2 of a tet's own energies, its volume's and the guard's [Pa]. Expects
// workspace.tet_volume.
double tet_volume_stiffness(const Model& model, const Workspace& workspace, std::size_t tet);

// Sum, for a node in the fixed order of its tets, of what workspace.tet_force holds.
inline Vec3 gather_tets(const Model& model, const Workspace& workspace, Index node) {
  Vec3 sum = Vec3::Zero();
  const auto n = uz(node);
  for (Index k = model.tet_start[n]; k < model.tet_start[n + 1]; ++k) {
    sum += workspace.tet_force[uz(model.node_tet[uz(k)])];
  }
  return sum;
}

// Square of the highest angular frequency [1/s2] that the guard adds: the largest g/V sum_a
// |dv/dx_a|^2 / m_a over the tets that it acts on, or that are about to come under it (0 where
// there is none). Expects workspace.tet_volume and tet_gradient of the step before: the guard sets
// in too fast for the explicit stepper to wait until the stable step is looked at. With packed
// forces: over the tets that they found low.
double guard_frequency2(const Model& model, const Workspace& workspace);

// Largest |J_c - 1| over the node cells [-]; 0 where there are none.
double largest_cell_change(const Model& model, std::span<const Vec3> x);

}  // namespace sinew
