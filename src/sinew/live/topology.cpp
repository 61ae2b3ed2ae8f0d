#include "sinew/live/topology.h"

#include <algorithm>

#include "sinew/mesh/surface.h"

namespace sinew::live {
namespace {

void add_coordinates(const Vec3& x, std::vector<float>& to) {
  for (int c = 0; c < 3; ++c) to.push_back(static_cast<float>(x[c]));
}

// Tets of the nodes that have a place in `of` (-1: none), as offsets and ids.
void list_tets(const Model& model, const std::vector<Index>& of, Topology& t) {
  t.tet_start.assign(t.node.size() + 1, 0);
  for (const Tet& tet : model.tets) {
    for (const Index n : tet) {
      if (of[uz(n)] >= 0) ++t.tet_start[uz(of[uz(n)]) + 1];
    }
  }
  for (std::size_t i = 0; i < t.node.size(); ++i) t.tet_start[i + 1] += t.tet_start[i];
  std::vector<Index> next(t.tet_start.begin(), t.tet_start.end() - 1);
  t.tet.resize(uz(t.tet_start.back()));
  for (Index e = 0; e < model.tet_count(); ++e) {
    for (const Index n : model.tets[uz(e)]) {
      if (of[uz(n)] >= 0) t.tet[uz(next[uz(of[uz(n)])]++)] = e;
    }
  }
}

// The region of a node is the last of its tets' regions: where two meet, the inner one shows.
void name_regions(const Model& model, Topology& t) {
  std::vector<int> first;  // of the bodies' regions in t.regions
  for (const Body& body : model.bodies) {
    first.push_back(static_cast<int>(t.regions.size()));
    for (const std::string& region : body.regions) {
      t.regions.push_back(body.regions.size() > 1 ? body.name + ": " + region : body.name);
    }
  }
  t.region.assign(t.node.size(), 0);
  std::size_t body = 0;
  for (std::size_t i = 0; i < t.node.size(); ++i) {
    while (t.node[i] >= model.bodies[body].nodes.end) ++body;
    int region = 0;
    for (Index k = t.tet_start[i]; k < t.tet_start[i + 1]; ++k) {
      region = std::max(region, first[body] + model.tet_region[uz(t.tet[uz(k)])]);
    }
    t.region[i] = static_cast<std::uint8_t>(std::min(region, 255));
  }
}

}  // namespace

Topology make_topology(const Model& model, std::uint32_t revision, const std::string& title) {
  Topology t;
  t.revision = revision;
  t.title = title;
  const Surface surface = build_surface(model.tets, model.node_count());
  std::vector<Index> of(uz(model.node_count()), -1);
  for (const Triangle& triangle : surface.triangles) {
    for (const Index n : triangle) of[uz(n)] = 0;
  }
  for (Index n = 0; n < model.node_count(); ++n) {
    if (of[uz(n)] < 0) continue;
    of[uz(n)] = static_cast<Index>(t.node.size());
    t.node.push_back(n);
  }
  double edges = 0.0;
  for (const Triangle& triangle : surface.triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      const auto a = uz(triangle[c]);
      const auto b = uz(triangle[(c + 1) % 3]);
      t.triangle.push_back(static_cast<std::uint32_t>(of[a]));
      edges += (model.rest_position[a] - model.rest_position[b]).norm();
    }
  }
  Vec3 low = Vec3::Zero();
  Vec3 high = Vec3::Zero();
  for (std::size_t i = 0; i < t.node.size(); ++i) {
    const auto n = uz(t.node[i]);
    const Vec3& X = model.rest_position[n];
    low = i == 0 ? X : Vec3(low.cwiseMin(X));
    high = i == 0 ? X : Vec3(high.cwiseMax(X));
    add_coordinates(X, t.rest);
    t.pinned.push_back(model.inverse_mass[n] == 0.0 ? 1 : 0);
  }
  t.diagonal = static_cast<float>((high - low).norm());
  if (!t.triangle.empty()) {
    t.edge = static_cast<float>(edges / static_cast<double>(t.triangle.size()));
  }
  list_tets(model, of, t);
  name_regions(model, t);
  return t;
}

}  // namespace sinew::live
