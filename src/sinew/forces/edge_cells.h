// The cells on which shear does not lock: the tets of one region around one edge, with their mean
// gradients (similar to ES-FEM, Liu et al. 2009). docs/methods/neo-hookean.md.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "sinew/mesh/tet_mesh.h"

namespace sinew {

struct EdgeCell {
  int region = 0;
  double volume = 0.0;       // V_e = sum_t V_t / 6 [m3]
  std::vector<Index> tets;   // ids in the mesh
  std::vector<Index> nodes;  // of its tets, ids in the mesh; the ends of the edge first
  std::vector<Vec3> sums;    // V_e g_a = sum_t (V_t / 6) G_ta [m2] (nodes)
};

// Visits the cells edge by edge; around an edge, region by region in the order of its tets.
// gradients: G_a of every tet [1/m] (tets); tet_region: (tets) or empty, all 0.
void for_each_edge_cell(const TetMesh& mesh, std::span<const std::array<Vec3, 4>> gradients,
                        std::span<const int> tet_region,
                        const std::function<void(const EdgeCell&)>& visit);

}  // namespace sinew
