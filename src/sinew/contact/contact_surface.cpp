#include "sinew/contact/contact_surface.h"

#include <algorithm>
#include <cmath>

#include "sinew/base/sort_by_key.h"
#include "sinew/mesh/surface.h"
#include "sinew/mesh/tet_mesh.h"

namespace sinew {
namespace {

double mean_side(const std::vector<Vec3>& x, const Triangle& t) {
  const Vec3 &a = x[uz(t[0])], &b = x[uz(t[1])], &c = x[uz(t[2])];
  return ((b - a).norm() + (c - b).norm() + (a - c).norm()) / 3.0;
}

double area(const std::vector<Vec3>& x, const Triangle& t) {
  const Vec3& a = x[uz(t[0])];
  return 0.5 * (x[uz(t[1])] - a).cross(x[uz(t[2])] - a).norm();
}

// The angle by which the surface turns at the edge from a to b; o and p are the corners opposite
// to it, of the triangle that holds the edge in this direction and of the other one.
double bend(const Vec3& a, const Vec3& b, const Vec3& o, const Vec3& p) {
  const Vec3 e = b - a;
  const Vec3 n0 = e.cross(o - a);
  const Vec3 n1 = (p - a).cross(e);
  const double angle = std::atan2(n0.cross(n1).norm(), n0.dot(n1));
  return n0.dot(p - a) <= 0.0 ? angle : -angle;  // p behind the first triangle: convex
}

// A side of a triangle: add_edges() pairs the sides that belong to one edge.
struct Side {
  Edge edge;
  Index triangle;
  int corner;  // the one opposite to the edge
};

void add_edges(const std::vector<Vec3>& x, Range triangles, ContactSurface& s) {
  std::vector<Side> sides;
  for (Index t = triangles.begin; t < triangles.end; ++t) {
    for (int c = 0; c < 3; ++c) {
      const Triangle& tri = s.triangles[uz(t)];
      const Index a = tri[static_cast<std::size_t>((c + 1) % 3)];
      const Index b = tri[static_cast<std::size_t>((c + 2) % 3)];
      sides.push_back({{std::min(a, b), std::max(a, b)}, t, c});
    }
  }
  std::stable_sort(sides.begin(), sides.end(),
                   [](const Side& a, const Side& b) { return a.edge < b.edge; });
  const Index first = static_cast<Index>(s.edges.size());
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t j = i + 1;
    while (j < sides.size() && sides[j].edge == sides[i].edge) ++j;
    s.edges.push_back(sides[i].edge);
    std::array<Index, 2> both = {sides[i].triangle, -1};
    double angle = 0.0;
    if (j > i + 2) both[1] = -2;
    if (j == i + 2) {
      both[1] = sides[i + 1].triangle;
      const Triangle& t0 = s.triangles[uz(both[0])];
      const auto c0 = static_cast<std::size_t>(sides[i].corner);
      const auto c1 = static_cast<std::size_t>(sides[i + 1].corner);
      angle = bend(x[uz(t0[(c0 + 1) % 3])], x[uz(t0[(c0 + 2) % 3])], x[uz(t0[c0])],
                   x[uz(s.triangles[uz(both[1])][c1])]);
    }
    s.edge_triangles.push_back(both);
    s.edge_bend.push_back(angle);
    i = j;
  }
  s.owner_edges.push_back({first, static_cast<Index>(s.edges.size())});
}

// The nodes of the triangles, ascending, without duplicates.
std::vector<Index> nodes_of(std::span<const Triangle> triangles) {
  std::vector<Index> nodes;
  for (const Triangle& t : triangles) nodes.insert(nodes.end(), t.begin(), t.end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

// Appends an owner. heights: of the tets behind the triangles; empty for a rigid mesh.
void add_owner(const std::vector<Vec3>& x, std::span<const Triangle> triangles,
               std::span<const double> heights, ContactSurface& s) {
  const Range range = {static_cast<Index>(s.triangles.size()),
                       static_cast<Index>(s.triangles.size() + triangles.size())};
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const double edge = mean_side(x, triangles[t]);
    s.triangles.push_back(triangles[t]);
    s.triangle_size.push_back(heights.empty() ? edge : std::min(edge, heights[t]));
  }
  s.owner_triangles.push_back(range);
  add_edges(x, range, s);

  const std::vector<Index> nodes = nodes_of(triangles);
  const auto count = static_cast<Index>(nodes.size());
  const auto before = static_cast<Index>(s.nodes.size());
  s.owner_nodes.push_back({before, before + count});
  std::vector<Index> start;
  std::vector<Index> corners;  // 3 t + corner, by node
  sort_by_key(
      nodes.size(), static_cast<Index>(3 * triangles.size()),
      [&](Index c) {
        const Index node = triangles[uz(c / 3)][uz(c % 3)];
        return static_cast<Index>(std::lower_bound(nodes.begin(), nodes.end(), node) -
                                  nodes.begin());
      },
      start, corners);
  if (s.ring_start.empty()) s.ring_start.push_back(0);
  for (Index i = 0; i < count; ++i) {
    double sum = 0.0;
    for (Index k = start[uz(i)]; k < start[uz(i) + 1]; ++k) {
      const Index t = range.begin + corners[uz(k)] / 3;
      s.ring.push_back(t);
      sum += s.triangle_size[uz(t)];
    }
    s.ring_start.push_back(static_cast<Index>(s.ring.size()));
    s.nodes.push_back(nodes[uz(i)]);
    s.node_size.push_back(sum / (start[uz(i) + 1] - start[uz(i)]));
  }
}

}  // namespace

void build_contact_surface(Model& model) {
  model.surface = {};
  const bool rigid = std::any_of(model.obstacles.begin(), model.obstacles.end(),
                                 [](const Obstacle& o) { return o.mesh() != nullptr; });
  if (!model.body_contact && !rigid) return;
  const Surface all = build_surface(model.tets, model.node_count());
  // The pieces that a cut leaves touch each other like bodies.
  const Components pieces =
      model.version > 0 ? connected_components(std::span<const Tet>(model.tets), model.node_count())
                        : Components{};
  for (const Body& body : model.bodies) {
    std::vector<Index> ids;
    for (Index t = body.tets.begin; t < body.tets.end; ++t) {
      const Index piece = model.version > 0 ? pieces.of[uz(t)] : 0;
      if (std::find(ids.begin(), ids.end(), piece) == ids.end()) ids.push_back(piece);
    }
    const Index first = model.surface.owner_count();
    for (const Index piece : ids) {
      std::vector<Triangle> triangles;
      std::vector<double> heights;
      for (std::size_t t = 0; t < all.triangles.size(); ++t) {
        if (!body.tets.contains(all.tets[t])) continue;
        if (model.version > 0 && pieces.of[uz(all.tets[t])] != piece) continue;
        const double volume = signed_volume(model.rest_position, model.tets[uz(all.tets[t])]);
        const double base = area(model.rest_position, all.triangles[t]);
        triangles.push_back(all.triangles[t]);
        heights.push_back(base > 0.0 ? 3.0 * volume / base : 0.0);
      }
      add_owner(model.rest_position, triangles, heights, model.surface);
    }
    model.surface.body_owners.push_back({first, model.surface.owner_count()});
  }
  model.surface.body_count = model.surface.owner_count();
  for (const Obstacle& o : model.obstacles) {
    if (o.mesh() != nullptr) add_rigid_contact_surface(model, o.mesh()->triangles);
  }
}

void add_rigid_contact_surface(Model& model, std::span<const Triangle> triangles) {
  add_owner(model.rest_position, triangles, {}, model.surface);
}

}  // namespace sinew
