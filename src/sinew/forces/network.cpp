#include "sinew/forces/network.h"

#include <algorithm>
#include <utility>

#include "sinew/base/parallel.h"
#include "sinew/forces/edge_cells.h"
#include "sinew/forces/gradient_cells.h"

namespace sinew {
namespace {

// The stiffnesses k_ij, j > i, of a node i, in the order in which its neighbours were found.
struct UpperRow {
  std::vector<Index> node;
  std::vector<double> stiffness;

  void add(Index j, double k) {
    const auto at = static_cast<std::size_t>(std::find(node.begin(), node.end(), j) - node.begin());
    if (at == node.size()) {
      node.push_back(j);
      stiffness.push_back(0.0);
    }
    stiffness[at] += k;
  }
};

// Adds -weight g_a . g_b to k of every pair of a cell's nodes.
void add_cell(std::span<const Index> nodes, std::span<const Vec3> g, double weight,
              std::vector<UpperRow>& rows) {
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    for (std::size_t b = a + 1; b < nodes.size(); ++b) {
      const auto [low, high] = std::minmax(nodes[a], nodes[b]);
      rows[uz(low)].add(high, -weight * g[a].dot(g[b]));
    }
  }
}

// Appends the rows of a body's nodes to those of the model, each in ascending order.
void append_rows(Model& model, const std::vector<UpperRow>& upper, Index first_node) {
  std::vector<Index> length(upper.size(), 0);
  for (std::size_t i = 0; i < upper.size(); ++i) {
    length[i] += static_cast<Index>(upper[i].node.size());
    for (const Index j : upper[i].node) ++length[uz(j)];
  }
  auto& start = model.network_start;
  start.resize(uz(first_node) + 1, start.empty() ? 0 : start.back());
  for (const Index n : length) start.push_back(start.back() + n);
  model.network_node.resize(uz(start.back()));
  model.network_stiffness.resize(uz(start.back()));
  std::vector<Index> next(start.begin() + first_node, start.end() - 1);
  const auto put = [&](std::size_t row, std::size_t column, double k) {
    const auto slot = uz(next[row]++);
    model.network_node[slot] = first_node + static_cast<Index>(column);
    model.network_stiffness[slot] = k;
  };
  // The lower neighbours of a node come first: they were added to its row before its own
  // neighbours.
  std::vector<std::pair<Index, double>> row;
  for (std::size_t i = 0; i < upper.size(); ++i) {
    row.clear();
    for (std::size_t k = 0; k < upper[i].node.size(); ++k) {
      row.emplace_back(upper[i].node[k], upper[i].stiffness[k]);
    }
    std::sort(row.begin(), row.end());
    for (const auto& [j, k] : row) {
      put(i, uz(j), k);
      put(uz(j), i, k);
    }
  }
}

}  // namespace

std::array<Vec3, 4> shape_gradients(const std::vector<Vec3>& nodes, const Tet& tet) {
  const Vec3& x0 = nodes[uz(tet[0])];
  Mat3 edges;
  edges << nodes[uz(tet[1])] - x0, nodes[uz(tet[2])] - x0, nodes[uz(tet[3])] - x0;
  const Mat3 inverse = edges.inverse();
  const Vec3 g1 = inverse.row(0);
  const Vec3 g2 = inverse.row(1);
  const Vec3 g3 = inverse.row(2);
  return {-(g1 + g2 + g3), g1, g2, g3};
}

void add_network(Model& model, const TetMesh& mesh, const std::vector<Material>& materials,
                 std::span<const int> tet_region, Index first_node) {
  const Index first_tet = model.tet_count() - mesh.tet_count();
  const auto region_of = [&](Index t) { return tet_region.empty() ? 0 : tet_region[uz(t)]; };
  const auto in_network = [&](const Material& m) { return m.law == Law::neo_hookean; };
  if (std::none_of(materials.begin(), materials.end(), in_network)) return;

  std::vector<std::array<Vec3, 4>> gradients(mesh.tets.size());
  parallel_for(mesh.tet_count(),
               [&](Index t) { gradients[uz(t)] = shape_gradients(mesh.nodes, mesh.tets[uz(t)]); });
  std::vector<UpperRow> upper(mesh.nodes.size());
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    const Material& m = materials[static_cast<std::size_t>(region_of(t))];
    if (!in_network(m) || m.beta == 0.0) continue;
    const double weight =
        m.beta * shear_modulus(m.young, m.poisson) * signed_volume(mesh.nodes, mesh.tets[uz(t)]);
    add_cell(mesh.tets[uz(t)], gradients[uz(t)], weight, upper);
  }
  for_each_edge_cell(mesh, gradients, tet_region, [&](const EdgeCell& cell) {
    const Material& m = materials[static_cast<std::size_t>(cell.region)];
    if (!in_network(m) || m.beta == 1.0) return;
    const double shear = (1.0 - m.beta) * shear_modulus(m.young, m.poisson);
    add_cell(cell.nodes, cell.sums, shear / cell.volume, upper);
    append_cell(model.edge_cells, cell.nodes, cell.sums, 1.0 / cell.volume, cell.volume,
                first_node);
    for (const Index t : cell.tets) {
      model.edge_tet.push_back(first_tet + t);
      model.edge_tet_cell.push_back(model.edge_cells.count() - 1);
    }
    model.edge_shear.push_back(shear);
    model.edge_bulk.push_back((1.0 - m.beta) * shear_bulk(m));
  });
  append_rows(model, upper, first_node);
}

double network_energy(const Model& model, std::span<const Vec3> x) {
  if (model.network_start.empty()) return 0.0;
  return parallel_sum(model.node_count(), [&](Index i) {
    const auto n = uz(i);
    double sum = 0.0;
    for (Index e = model.network_start[n]; e < model.network_start[n + 1]; ++e) {
      const auto j = uz(model.network_node[uz(e)]);
      if (j < n) continue;
      const Vec3 now = x[j] - x[n];
      const Vec3 rest = model.rest_position[j] - model.rest_position[n];
      // now|^2 - |rest|^2 without cancellation
      sum += 0.5 * model.network_stiffness[uz(e)] * (now - rest).dot(now + rest);
    }
    return sum;
  });
}

}  // namespace sinew
