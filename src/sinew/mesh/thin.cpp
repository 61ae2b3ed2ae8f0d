#include "sinew/mesh/thin.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sinew/mesh/edges.h"
#include "sinew/mesh/surface.h"

namespace sinew {
namespace {

constexpr double thin_ratio = 6.0;     // length over thickness of a thin body
constexpr double longest_ratio = 1.3;  // mean edge over thickness that still bends well

double mean_edge_of(const TetMesh& mesh) {
  const EdgeTable table = build_edges(mesh.tets, mesh.node_count());
  double sum = 0.0;
  for (const Edge& e : table.edges) sum += (mesh.nodes[uz(e[0])] - mesh.nodes[uz(e[1])]).norm();
  return sum / std::max(1.0, static_cast<double>(table.edges.size()));
}

// The share of the volume in tets with all nodes on the surface.
double share_of_one_layer(const TetMesh& mesh, const Surface& surface, double volume) {
  std::vector<char> outer(mesh.nodes.size(), 0);
  for (const Triangle& t : surface.triangles) {
    for (const Index i : t) outer[uz(i)] = 1;
  }
  double sum = 0.0;
  for (const Tet& t : mesh.tets) {
    if (std::all_of(t.begin(), t.end(), [&](Index i) { return outer[uz(i)] != 0; }))
      sum += signed_volume(mesh.nodes, t);
  }
  return sum / volume;
}

}  // namespace

std::optional<std::string> thin_warning(const TetMesh& mesh) {
  if (mesh.tets.empty()) return std::nullopt;
  const Surface surface = build_surface(mesh.tets, mesh.node_count());
  double volume = 0.0;
  for (const Tet& t : mesh.tets) volume += signed_volume(mesh.nodes, t);
  const double thickness = 2.0 * volume / surface_area(mesh.nodes, surface.triangles);
  Vec3 low = mesh.nodes[uz(mesh.tets[0][0])], high = low;
  for (const Tet& t : mesh.tets) {
    for (const Index i : t) {
      low = low.cwiseMin(mesh.nodes[uz(i)]);
      high = high.cwiseMax(mesh.nodes[uz(i)]);
    }
  }
  if (!(thickness > 0.0) || !((high - low).maxCoeff() > thin_ratio * thickness))
    return std::nullopt;
  const double edge = mean_edge_of(mesh);
  if (share_of_one_layer(mesh, surface, volume) > 0.5) {
    return fmt::format(
        "thin: most tets reach from one side to the other (about {:.3g} m); one layer of tets "
        "bends too stiffly, by 15 % to several times; mesh it with two layers or more",
        thickness);
  }
  if (edge > longest_ratio * thickness) {
    return fmt::format(
        "thin: the tets' edges are {:.3g} m long and the body is about {:.3g} m thick; it bends "
        "too stiffly by 10 % or more; make the edges no longer than the thickness",
        edge, thickness);
  }
  return std::nullopt;
}

}  // namespace sinew
