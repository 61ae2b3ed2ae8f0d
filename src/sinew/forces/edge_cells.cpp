#include "sinew/forces/edge_cells.h"

#include <algorithm>

#include "sinew/base/cancel.h"
#include "sinew/mesh/edges.h"

namespace sinew {
namespace {

void add_tet(const TetMesh& mesh, std::span<const std::array<Vec3, 4>> gradients, Index tet,
             EdgeCell& cell) {
  const auto t = uz(tet);
  const double share = signed_volume(mesh.nodes, mesh.tets[t]) / 6.0;
  cell.volume += share;
  cell.tets.push_back(tet);
  for (std::size_t a = 0; a < 4; ++a) {
    const Index node = mesh.tets[t][a];
    const auto found = std::find(cell.nodes.begin(), cell.nodes.end(), node);
    if (found == cell.nodes.end()) {
      cell.nodes.push_back(node);
      cell.sums.push_back(share * gradients[t][a]);
    } else {
      cell.sums[static_cast<std::size_t>(found - cell.nodes.begin())] += share * gradients[t][a];
    }
  }
}

}  // namespace

void for_each_edge_cell(const TetMesh& mesh, std::span<const std::array<Vec3, 4>> gradients,
                        std::span<const int> tet_region,
                        const std::function<void(const EdgeCell&)>& visit) {
  const auto region_of = [&](Index t) { return tet_region.empty() ? 0 : tet_region[uz(t)]; };
  const EdgeTable table = build_edges(mesh.tets, mesh.node_count());
  EdgeCell cell;
  std::vector<int> regions;
  for (Index e = 0; e < table.edge_count(); ++e) {
    stop_if_cancelled();
    const std::span<const Index> around = table.tets_of(e);
    regions.clear();
    for (const Index t : around) {
      if (std::find(regions.begin(), regions.end(), region_of(t)) == regions.end()) {
        regions.push_back(region_of(t));
      }
    }
    for (const int r : regions) {
      cell.region = r;
      cell.volume = 0.0;
      cell.tets.clear();
      cell.nodes.clear();
      cell.sums.clear();
      for (const Index end : table.edges[uz(e)]) {
        cell.nodes.push_back(end);
        cell.sums.push_back(Vec3::Zero());
      }
      for (const Index t : around) {
        if (region_of(t) == r) add_tet(mesh, gradients, t, cell);
      }
      if (cell.volume > 0.0) visit(cell);
    }
  }
}

}  // namespace sinew
