// The network of the law neo-hookean: springs of rest length zero with constant stiffness.
// docs/methods/neo-hookean.md.
#pragma once

#include <span>
#include <vector>

#include "sinew/mesh/tet_mesh.h"
#include "sinew/model/model.h"

namespace sinew {

// Gradients of the linear shape functions of a tet, G_a [1/m]: grad u = sum_a u_a G_a^T.
std::array<Vec3, 4> shape_gradients(const std::vector<Vec3>& nodes, const Tet& tet);

// Appends the rows of a body's nodes, the model's next ones, to the model's network:
//
//   k_ij = -L_ij,   L = sum over regions r of (1 - beta_r) L_edge,r + beta_r L_tet,r
//   L_tet,r  = sum_{t in r} mu_t V_t G_a . G_b
//   L_edge,r = sum_e V_e mu_r g_a . g_b,  V_e = sum_{t in r around e} V_t/6,
//              g_a = (sum_{t in r around e} (V_t/6) G_ta) / V_e
//
// and the cells of L_edge to its edge cells, with (1 - beta_r) mu_r and (1 - beta_r) kappa_e,r.
//
// The mesh's tets are the model's last ones. Only tets whose material has the law neo-hookean take
// part. tet_region: (tets) or empty.
void add_network(Model& model, const TetMesh& mesh, const std::vector<Material>& materials,
                 std::span<const int> tet_region, Index first_node);

// The force of the network on the node, sum_j k_ij (x_j - x_i) [N].
inline Vec3 network_force(const Model& model, std::span<const Vec3> x, Index node) {
  Vec3 sum = Vec3::Zero();
  const auto n = uz(node);
  for (Index e = model.network_start[n]; e < model.network_start[n + 1]; ++e) {
    const auto k = uz(e);
    sum += model.network_stiffness[k] * (x[uz(model.network_node[k])] - x[n]);
  }
  return sum;
}

// sum_{i<j} k_ij/2 (|x_ij|^2 - |X_ij|^2) [J]: zero at rest.
double network_energy(const Model& model, std::span<const Vec3> x);

}  // namespace sinew
