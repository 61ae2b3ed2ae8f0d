#include "sinew/forces/network.h"

#include <algorithm>
#include <cstdint>

#include "sinew/base/parallel.h"
#include "sinew/forces/edge_cells.h"

namespace sinew {
namespace {

struct Entry {
  std::int64_t pair = 0;  // row * nodes + column, row < column, ids in the mesh
  double stiffness = 0.0;
};

// Adds -weight g_a . g_b to k of every pair of a cell's nodes.
void add_cell(std::span<const Index> nodes, std::span<const Vec3> g, double weight, Index count,
              std::vector<Entry>& entries) {
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    for (std::size_t b = a + 1; b < nodes.size(); ++b) {
      const std::int64_t low = std::min(nodes[a], nodes[b]);
      const std::int64_t high = std::max(nodes[a], nodes[b]);
      entries.push_back({low * count + high, -weight * g[a].dot(g[b])});
    }
  }
}

// Sums the entries of equal pairs, in the order in which they were added.
void merge(std::vector<Entry>& entries) {
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry& a, const Entry& b) { return a.pair < b.pair; });
  std::size_t kept = 0;
  for (std::size_t e = 0; e < entries.size(); ++e) {
    if (kept > 0 && entries[kept - 1].pair == entries[e].pair) {
      entries[kept - 1].stiffness += entries[e].stiffness;
    } else {
      entries[kept++] = entries[e];
    }
  }
  entries.resize(kept);
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
  const auto region_of = [&](Index t) { return tet_region.empty() ? 0 : tet_region[uz(t)]; };
  const auto in_network = [&](const Material& m) { return m.law == Law::neo_hookean; };
  if (std::none_of(materials.begin(), materials.end(), in_network)) return;

  std::vector<std::array<Vec3, 4>> gradients(mesh.tets.size());
  parallel_for(mesh.tet_count(),
               [&](Index t) { gradients[uz(t)] = shape_gradients(mesh.nodes, mesh.tets[uz(t)]); });
  std::vector<Entry> entries;
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    const Material& m = materials[static_cast<std::size_t>(region_of(t))];
    const double beta = network_beta(m);
    if (!in_network(m) || beta == 0.0) continue;
    const double weight =
        beta * shear_modulus(m.young, m.poisson) * signed_volume(mesh.nodes, mesh.tets[uz(t)]);
    add_cell(mesh.tets[uz(t)], gradients[uz(t)], weight, mesh.node_count(), entries);
  }
  for_each_edge_cell(mesh, gradients, tet_region, [&](const EdgeCell& cell) {
    const Material& m = materials[static_cast<std::size_t>(cell.region)];
    const double beta = network_beta(m);
    if (!in_network(m) || beta == 1.0) return;
    const double shear = (1.0 - beta) * shear_modulus(m.young, m.poisson);
    add_cell(cell.nodes, cell.sums, shear / cell.volume, mesh.node_count(), entries);
  });
  merge(entries);

  // Rows from the upper triangle: the lower neighbours of a node come first, in increasing order,
  // because the entries are sorted by row and then by column.
  const auto count = uz(mesh.node_count());
  const auto first = uz(first_node);
  const auto filled = static_cast<Index>(model.network_node.size());
  model.network_start.resize(first + count + 1,
                             model.network_start.empty() ? 0 : model.network_start.back());
  std::vector<Index> length(count, 0);
  for (const Entry& entry : entries) {
    ++length[static_cast<std::size_t>(entry.pair / mesh.node_count())];
    ++length[static_cast<std::size_t>(entry.pair % mesh.node_count())];
  }
  std::vector<Index> next(count, filled);
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0) next[i] = next[i - 1] + length[i - 1];
    model.network_start[first + i + 1] = next[i] + length[i];
  }
  model.network_node.resize(uz(filled) + 2 * entries.size());
  model.network_stiffness.resize(model.network_node.size());
  const auto put = [&](std::int64_t row, std::int64_t column, double k) {
    const auto slot = uz(next[static_cast<std::size_t>(row)]++);
    model.network_node[slot] = first_node + static_cast<Index>(column);
    model.network_stiffness[slot] = k;
  };
  for (const Entry& entry : entries) {
    put(entry.pair / mesh.node_count(), entry.pair % mesh.node_count(), entry.stiffness);
    put(entry.pair % mesh.node_count(), entry.pair / mesh.node_count(), entry.stiffness);
  }
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
      // |now|^2 - |rest|^2 without the loss of digits
      sum += 0.5 * model.network_stiffness[uz(e)] * (now - rest).dot(now + rest);
    }
    return sum;
  });
}

}  // namespace sinew
