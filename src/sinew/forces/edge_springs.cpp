#include "sinew/forces/edge_springs.h"

#include <algorithm>
#include <array>

#include "sinew/forces/network.h"
#include "sinew/mesh/edges.h"

namespace sinew {
namespace {

double spring_of_tet(const Model& model, std::size_t t, Index i, Index j) {
  const double shear = model.tet_shear[t];
  if (shear == 0.0) return 0.0;
  const Tet& tet = model.tets[t];
  const std::array<Vec3, 4> gradient = shape_gradients(model.rest_position, tet);
  const auto of = [&](Index node) {
    const auto corner = std::find(tet.begin(), tet.end(), node) - tet.begin();
    return gradient[static_cast<std::size_t>(corner)];
  };
  return -shear * model.rest_volume[t] * of(i).dot(of(j));
}

}  // namespace

EdgeSprings find_edge_springs(const Model& model) {
  EdgeSprings found;
  const GradientCells& cells = model.edge_cells;
  found.stiffness.assign(uz(cells.count()), 0.0);
  std::vector<char> in_cell(model.tets.size(), 0);
  for (std::size_t k = 0; k < model.edge_tet.size(); ++k) {
    const auto t = uz(model.edge_tet[k]);
    const Index e = model.edge_tet_cell[k];
    const auto ends = uz(cells.slots(e).begin);  // the edge's ends come first
    in_cell[t] = 1;
    found.stiffness[uz(e)] += spring_of_tet(model, t, cells.node[ends], cells.node[ends + 1]);
  }
  std::vector<Tet> bare;
  std::vector<std::size_t> ids;
  for (std::size_t t = 0; t < model.tets.size(); ++t) {
    if (in_cell[t] != 0 || model.tet_shear[t] == 0.0) continue;
    bare.push_back(model.tets[t]);
    ids.push_back(t);
  }
  EdgeTable table = build_edges(bare, model.node_count());
  for (Index e = 0; e < table.edge_count(); ++e) {
    const auto [i, j] = table.edges[uz(e)];
    double sum = 0.0;
    for (const Index k : table.tets_of(e)) sum += spring_of_tet(model, ids[uz(k)], i, j);
    found.stiffness.push_back(sum);
  }
  found.bare = std::move(table.edges);
  return found;
}

}  // namespace sinew
