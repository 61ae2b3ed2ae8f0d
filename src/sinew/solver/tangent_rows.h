// The inner loops of TangentMatrix on plain arrays, compiled for several instruction sets.
#pragma once

#include <span>
#include <vector>

#include "sinew/solver/float4.h"

namespace sinew {

// The arrays of tangent_matrix.h that a product needs.
struct TangentRows {
  const char* free;          // (nodes)
  const Block3* own;         // D_i (nodes)
  const Index* near_start;   // all even (nodes + 1)
  const Index* near;         // neighbours; a row of odd length is padded with the node itself
  const Float4* near_block;  // columns of B_ij: column c of entry e at near_column(e, c)
  const Index* far_start;    // all even (nodes + 1)
  const Index* far;
  const float* far_stiffness;
  const Index* cell_start;  // (cells + 1)
  const Index* cell_node;
  const Float4* gradient;  // G_ci (as cell_node)
  const float* cell_stiffness;
  const Index* node_start;  // (nodes + 1); null: no cells
  const Index* node_cell;
  const Float4* node_gradient;  // G_ci (as node_cell)
};

// Two entries are stored side by side, so that their columns load together.
inline std::size_t near_column(std::size_t entry, std::size_t column) {
  return 6 * (entry / 2) + 2 * column + entry % 2;
}

// push_c = cell_stiffness_c G_c . u for the cells of the range.
void tangent_cells(const TangentRows& rows, const Float4* u, Range cells, float* pressure);

// out_i = (K u)_i for the nodes of the range. Returns the sum of u_i . out_i.
double tangent_nodes(const TangentRows& rows, const Float4* u, const float* pressure, Range nodes,
                     Float4* out);

// What the blocks between the nodes of an edge cell need (forces/edge_volume.h): g_a [1/m], and
// sqrt(V kappa) cof F g_a.
struct CellSlot {
  Float4 gradient, push;
};
// Two nodes of a cell, by their slots.
struct CellPair {
  Index cell, a, b;
};
// turn += sum V s F (g_a x g_b) and press += sum V kappa (cof F g_a)(cof F g_b)^T over the pairs.
// cell_turn: V s F (cells).
void add_cell_pairs(std::span<const CellPair> pairs, const CellSlot* slots, const Block3* cell_turn,
                    Float4& turn, Block3& press);

}  // namespace sinew
