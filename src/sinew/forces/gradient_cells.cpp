#include "sinew/forces/gradient_cells.h"

#include "sinew/base/sort_by_key.h"

namespace sinew {

void append_cell(GradientCells& cells, std::span<const Index> nodes, std::span<const Vec3> g,
                 double scale, double volume, Index first_node) {
  if (cells.start.empty()) cells.start.push_back(0);
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    cells.node.push_back(first_node + nodes[a]);
    cells.gradient.push_back(scale * g[a]);
  }
  cells.volume.push_back(volume);
  cells.start.push_back(static_cast<Index>(cells.node.size()));
}

void finish(GradientCells& cells, std::size_t node_count) {
  cells.slot_cell.clear();
  for (Index cell = 0; cell < cells.count(); ++cell) {
    cells.slot_cell.resize(uz(cells.slots(cell).end), cell);
  }
  sort_by_key(
      node_count, static_cast<Index>(cells.node.size()),
      [&](Index slot) { return cells.node[uz(slot)]; }, cells.node_start, cells.node_slot);
}

}  // namespace sinew
