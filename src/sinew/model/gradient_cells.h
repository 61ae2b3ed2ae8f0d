// Cells of tets with one mean deformation gradient, F = sum_a x_a g_a^T over the cell's nodes a.
#pragma once

#include <vector>

#include "sinew/base/parallel.h"
#include "sinew/base/vec.h"

namespace sinew {

// A slot is a node of a cell. The gradients of a cell sum to zero.
struct GradientCells {
  std::vector<Index> start;    // offsets of the cells' slots (cells + 1); empty: no cells
  std::vector<Index> node;     // node ids (slots)
  std::vector<Vec3> gradient;  // g_a [1/m] (slots)
  std::vector<double> volume;  // rest volume [m3] (cells)

  // Node -> its slots, for a gather in a fixed order (forces/gradient_cells.h).
  std::vector<Index> node_start;  // offsets into node_slot (nodes + 1)
  std::vector<Index> node_slot;   // slots of the node, ascending
  std::vector<Index> slot_cell;   // (slots)

  Index count() const { return static_cast<Index>(volume.size()); }
  Range slots(Index cell) const { return {start[uz(cell)], start[uz(cell) + 1]}; }
};

}  // namespace sinew
