// The deformation gradient of GradientCells, and the forces of their stresses.
#pragma once

#include <span>

#include "sinew/model/gradient_cells.h"

namespace sinew {

// Appends a cell with the gradients scale * g[a] on the nodes first_node + nodes[a].
void append_cell(GradientCells& cells, std::span<const Index> nodes, std::span<const Vec3> g,
                 double scale, double volume, Index first_node);

// Derives slot_cell and the list node -> slots; called once, when all cells are there.
void finish(GradientCells& cells, std::size_t node_count);

// sum_a (x_a - x_0) g_a^T. Since sum_a g_a = 0, x_a gives the same sum, but x_a - x_0 is more
// accurate far from the origin.
inline Mat3 cell_gradient(const GradientCells& cells, std::span<const Vec3> x, Index cell) {
  const Range slots = cells.slots(cell);
  auto s = uz(slots.begin);
  const Vec3 x0 = x[uz(cells.node[s])];
  Mat3 sum = Mat3::Zero();
  for (++s; s < uz(slots.end); ++s) {
    const Vec3 offset = x[uz(cells.node[s])] - x0;
    const Vec3& g = cells.gradient[s];
    for (int c = 0; c < 3; ++c) sum.col(c) += g[c] * offset;
  }
  return sum;
}

// sum P_c g_a over the node's slots in their fixed order, P (cells): minus the force on the node if
// P is V times the first Piola-Kirchhoff stress of the cell [J].
inline Vec3 stress_on_node(const GradientCells& cells, std::span<const Mat3> stress, Index node) {
  Vec3 sum = Vec3::Zero();
  for (Index k = cells.node_start[uz(node)]; k < cells.node_start[uz(node) + 1]; ++k) {
    const auto slot = uz(cells.node_slot[uz(k)]);
    sum += stress[uz(cells.slot_cell[slot])] * cells.gradient[slot];
  }
  return sum;
}

}  // namespace sinew
