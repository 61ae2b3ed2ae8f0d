#include "sinew/mesh/pinches.h"

#include <algorithm>

#include "sinew/mesh/surface.h"

namespace sinew {

std::vector<Edge> non_manifold_edges(std::span<const Triangle> triangles) {
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(t[k], t[(k + 1) % 3]);
      edges.push_back({a, b});
    }
  }
  std::sort(edges.begin(), edges.end());
  std::vector<Edge> found;
  for (auto edge = edges.begin(); edge != edges.end();) {
    const auto next = std::find_if(edge, edges.end(), [&](const Edge& e) { return e != *edge; });
    if (next - edge > 2) found.push_back(*edge);
    edge = next;
  }
  return found;
}

std::vector<Index> non_manifold_nodes(std::span<const Triangle> triangles) {
  struct Spoke {  // the triangle at `node` that holds the edge to `other`
    Index node, other, triangle;
    auto operator<=>(const Spoke&) const = default;
  };
  std::vector<Spoke> spokes;
  spokes.reserve(6 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const Index node : triangles[t]) {
      for (const Index other : triangles[t]) {
        if (other != node) spokes.push_back({node, other, static_cast<Index>(t)});
      }
    }
  }
  std::sort(spokes.begin(), spokes.end());

  std::vector<Index> found;
  for (auto begin = spokes.begin(); begin != spokes.end();) {
    const auto end =
        std::find_if(begin, spokes.end(), [&](const Spoke& s) { return s.node != begin->node; });
    // Each triangle is an edge between its two spokes' other ends: count the connected sets.
    std::vector<Index> ends;
    for (auto s = begin; s != end; ++s) {
      if (ends.empty() || ends.back() != s->other) ends.push_back(s->other);
    }
    const auto local = [&](Index node) {
      return static_cast<Index>(std::lower_bound(ends.begin(), ends.end(), node) - ends.begin());
    };
    std::vector<Triangle> links;
    for (auto s = begin; s != end; ++s) {
      for (const Index third : triangles[uz(s->triangle)]) {
        if (third != begin->node) links.push_back({local(s->other), local(third), local(third)});
      }
    }
    if (connected_components(links, static_cast<Index>(ends.size())).count > 1) {
      found.push_back(begin->node);
    }
    begin = end;
  }
  return found;
}

}  // namespace sinew
