#include "sinew/live/topology.h"

#include <algorithm>

#include "sinew/mesh/surface.h"

namespace sinew::live {
namespace {

void add_coordinates(const Vec3& x, std::vector<float>& to) {
  for (int c = 0; c < 3; ++c) to.push_back(static_cast<float>(x[c]));
}

// Lists the tets of the nodes that have a number in `of` (-1: none), as offsets and ids.
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

// The region of a node is the last of its tets' regions, so the inner region shows at a border.
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
    if (t.node[i] >= model.body_node_count()) break;  // anchors of attachments
    while (t.node[i] >= model.bodies[body].nodes.end) ++body;
    int region = 0;
    for (Index k = t.tet_start[i]; k < t.tet_start[i + 1]; ++k) {
      region = std::max(region, first[body] + model.tet_region[uz(t.tet[uz(k)])]);
    }
    t.region[i] = static_cast<std::uint8_t>(std::min(region, 255));
  }
}

// The tets that the cut does not hide.
std::vector<Tet> tets_left(const Model& model, const Cut& cut) {
  if (cut.normal.isZero()) return model.tets;
  std::vector<Tet> left;
  double least = no_limit;
  Tet last{};
  for (const Tet& tet : model.tets) {
    Vec3 middle = Vec3::Zero();
    for (const Index n : tet) middle += 0.25 * model.rest_position[uz(n)];
    const double height = cut.normal.dot(middle);
    if (height <= cut.offset) left.push_back(tet);
    if (height < least) {
      least = height;
      last = tet;
    }
  }
  if (left.empty() && !model.tets.empty()) left.push_back(last);
  return left;
}

// Marks the shown nodes by 0, the others by -1.
std::vector<Index> shown_nodes(const Model& model, const std::vector<Tet>& tets,
                               const Surface& surface, bool springs) {
  std::vector<Index> of(uz(model.node_count()), -1);
  if (springs) {
    for (const Tet& tet : tets) {
      for (const Index n : tet) of[uz(n)] = 0;
    }
    std::fill(of.begin() + model.body_node_count(), of.end(), 0);
  } else {
    for (const Triangle& triangle : surface.triangles) {
      for (const Index n : triangle) of[uz(n)] = 0;
    }
  }
  return of;
}

void list_springs(const Model& model, const std::vector<Index>& of, Topology& t) {
  for (const Edge& spring : model.springs) {
    const Index a = of[uz(spring[0])];
    const Index b = of[uz(spring[1])];
    if (a < 0 || b < 0) continue;
    t.spring.push_back(static_cast<std::uint32_t>(a));
    t.spring.push_back(static_cast<std::uint32_t>(b));
  }
}

double diagonal_of(const Model& model) {
  const Index n = model.body_node_count();
  if (n == 0) return 0.0;
  Vec3 low = model.rest_position.front();
  Vec3 high = low;
  for (Index i = 0; i < n; ++i) {
    low = low.cwiseMin(model.rest_position[uz(i)]);
    high = high.cwiseMax(model.rest_position[uz(i)]);
  }
  return (high - low).norm();
}

}  // namespace

Topology make_topology(const Model& model, std::uint32_t revision, const Cut& cut, bool springs) {
  Topology t;
  t.revision = revision;
  const std::vector<Tet> tets = tets_left(model, cut);
  const Surface surface = build_surface(tets, model.node_count());
  std::vector<Index> of = shown_nodes(model, tets, surface, springs);
  for (Index n = 0; n < model.node_count(); ++n) {
    if (of[uz(n)] < 0) continue;
    of[uz(n)] = static_cast<Index>(t.node.size());
    t.node.push_back(n);
    add_coordinates(model.rest_position[uz(n)], t.rest);
    t.pinned.push_back(model.inverse_mass[uz(n)] == 0.0 ? 1 : 0);
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
  t.diagonal = static_cast<float>(diagonal_of(model));
  if (!t.triangle.empty()) {
    t.edge = static_cast<float>(edges / static_cast<double>(t.triangle.size()));
  }
  if (springs) list_springs(model, of, t);
  list_tets(model, of, t);
  name_regions(model, t);
  return t;
}

}  // namespace sinew::live
