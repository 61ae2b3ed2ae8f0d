// Volume terms: the energies that keep the volume of tets and node cells, and the pressure of the
// network law.
//
//   W(x) = sum_t [ -mu_t (v_t - V_t) + V_t kappa_t/2 (v_t/V_t - 1)^2 + guard ]
//        + sum_c V_c kappa_c/2 (J_c - 1)^2,   J_c = (sum of its shares of v_t) / V_c
//
// so that the force on node i is -sum_{t at i} s_t dv_t/dx_i with the tet's pressure
//   s_t = -mu_t + kappa_t (v_t/V_t - 1) + (its cells' kappa_c (J_c - 1), by their shares) + guard.
// Edge cells add their own (forces/edge_volume.h). docs/methods/volume.md.
#pragma once

#include <span>
#include <vector>

#include "sinew/forces/edge_volume.h"
#include "sinew/forces/volume_law.h"
#include "sinew/mesh/tet_mesh.h"
#include "sinew/model/model.h"

namespace sinew {

// Appends the volume terms of a body's tets, the model's last ones: tet_shear, tet_bulk, tet_guard,
// and a cell for every node and region.
void add_volume_terms(Model& model, const Body& body, const std::vector<Material>& materials);

// Removes cells that would lock (choose_cells() in volume.cpp), shares the tets among the others
// and derives the lists cell -> tets and node -> tets; called once, by finish(), which knows the
// pins.
void finish_volume_terms(Model& model);

// Whether some energy keeps the volume of the tet.
bool keeps_volume(const Model& model, Index tet);

// The volume of every tet and its gradient at given positions; empty if the model has no volume
// terms.
struct TetVolumes {
  std::vector<double> volume;     // v_t [m3] (tets)
  std::vector<Corners> gradient;  // dv_t/dx of the corners [m2] (tets)
};

// The same with the pressures: all that the forces of the volume terms and their tangent need.
struct TetState : TetVolumes {
  std::vector<double> pressure;       // s_t [Pa] (tets)
  std::vector<double> cell_pressure;  // kappa_c (J_c - 1) [Pa] (cells)
  EdgeState edges;
};

// The results depend on x only. The arrays of `reuse` become those of the result, so a caller that
// passes in the last result allocates nothing.
TetVolumes compute_tet_volumes(const Model& model, std::span<const Vec3> x, TetVolumes reuse = {});
TetState compute_tet_state(const Model& model, std::span<const Vec3> x, TetState reuse = {});
// Only v_t [m3] (tets), to the same bits.
std::vector<double> volumes_of_tets(const Model& model, std::span<const Vec3> x,
                                    std::vector<double> reuse = {});
// Only s_t [Pa] (tets).
std::vector<double> pressures_of_tets(const Model& model, std::span<const Vec3> x);

// A tet that has lost half of its volume or more: the guard acts on it or may act within a step, or
// it is inverted.
struct LowTet {
  Index tet = -1;
  double volume = 0.0;  // [m3]
  Corners gradient;     // [m2]
};
LowTet low_tet_at(const Model& model, std::span<const Vec3> x, Index tet);
// All low tets, by id: those of `tets`, written to `low`, or those at positions x.
void find_low_tets(const Model& model, const TetVolumes& tets, std::vector<LowTet>& low);
std::vector<LowTet> find_low_tets(const Model& model, std::span<const Vec3> x);

// sum_t p_t dv_t/dx_i over the node's tets in their fixed order, p (tets).
inline Vec3 press_tets(const Model& model, std::span<const Corners> gradient,
                       std::span<const double> p, Index node) {
  Vec3 sum = Vec3::Zero();
  const auto n = uz(node);
  for (Index k = model.tet_start[n]; k < model.tet_start[n + 1]; ++k) {
    const auto corner = uz(model.node_tet[uz(k)]);
    sum += p[corner / 4] * gradient[corner / 4][corner % 4];
  }
  return sum;
}

// The force of tets, node cells and edge cells on the node [N]: -sum_t s_t dv_t/dx_i over its tets
// and -sum_e V_e s_e cof F_e g_i over its edge cells, in their fixed order.
inline Vec3 volume_force(const Model& model, const TetState& tets, Index node) {
  return -press_tets(model, tets.gradient, tets.pressure, node) -
         stress_on_node(model.edge_cells, tets.edges.stress, node);
}

// W [J] of tets and node cells with these volumes [m3] (tets): zero at rest.
double volume_energy(const Model& model, std::span<const double> volume);

// The change of the forces of tets, node cells and edge cells due to a displacement u, to first
// order. Keeps its arrays between calls.
class VolumeForceChange {
 public:
  void compute(const Model& model, std::span<const Vec3> x, const TetState& tets,
               std::span<const Vec3> u);
  // -H u on the node [N].
  Vec3 of(const Model& model, Index node) const;

 private:
  std::vector<double> tet_rate_;   // change of v_t [m3] (tets)
  std::vector<double> cell_rate_;  // change of the pressure [Pa] (cells)
  std::vector<Vec3> force_;        // on the corners [N] (4 per tet)
  std::vector<Mat3> edge_stress_;  // change of V_e s_e cof F_e [J] (edge cells)
};

// --- functions for the projection on the cells' volumes (volume_limit.h) ---

// The sum over the cell's tets of its share times a value per tet (tets); for tet volumes the
// volume of the cell.
inline double sum_of_cell(const Model& model, std::size_t cell, std::span<const double> of_tet) {
  double sum = 0.0;
  for (Index k = model.cell_start[cell]; k < model.cell_start[cell + 1]; ++k) {
    sum += model.cell_weight[uz(k)] * of_tet[uz(model.cell_tet[uz(k)])];
  }
  return sum;
}
// The change of the cells' volumes due to u, to first order [m3] (cells). tet_rate: that of the
// tets.
void rate_cells(const Model& model, const TetVolumes& tets, std::span<const Vec3> u,
                std::vector<double>& tet_rate, std::span<double> rate);
// Sets the `pressure` (tets) with which press_tets() gives the gradient of sum_c weight_c V_c(x).
void press_cells(const Model& model, std::span<const double> weight, std::vector<double>& pressure);

// V d2W/dv2 of a tet's own energies (volume and guard) [Pa], at this volume [m3].
double tet_volume_stiffness(const Model& model, std::size_t tet, double volume);

// Square of the highest angular frequency [1/s2] that the guard adds: the largest g/V sum_a
// |dv/dx_a|^2 / m_a over the tets that the guard acts on or may act on within a step (0 if there
// are none). The guard stiffens too fast for the explicit stepper to wait for the next check of the
// stable step.
double guard_frequency2(const Model& model, std::span<const LowTet> low);

// Largest |J_c - 1| over the node cells [-]; 0 if there are none.
double largest_cell_change(const Model& model, std::span<const Vec3> x);

}  // namespace sinew
