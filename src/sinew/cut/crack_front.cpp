#include "sinew/cut/crack_front.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "sinew/mesh/surface.h"
#include "sinew/mesh/tet_mesh.h"

namespace sinew {
namespace {

constexpr double sharp = 290.0 / 180.0 * std::numbers::pi;  // [rad]

// The part of v across the unit vector `axis`, of length 1; zero if there is none.
Vec3 across(const Vec3& v, const Vec3& axis) {
  const Vec3 w = v - axis.dot(v) * axis;
  const double length = w.norm();
  return length > 0.0 ? Vec3(w / length) : Vec3(Vec3::Zero());
}

// v or -v, whichever leads the way that `like` does.
Vec3 turned_to(const Vec3& v, const Vec3& like) {
  return v.dot(like) < 0.0 ? Vec3(-v) : v;
}

// What the edges of the surface see: the tets' angles around them, and the directions in which
// their two faces lead away.
struct Around {
  double angle = 0.0;  // [rad]
  Vec3 away = Vec3::Zero();
};

std::map<Edge, Around> edges_of_surface(const Model& model, const Body& body) {
  std::map<Edge, Around> found;
  const auto& X = model.rest_position;
  const std::span<const Tet> tets(model.tets.data() + body.tets.begin, uz(body.tets.size()));
  for (const Triangle& f : build_surface(tets, model.node_count()).triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = f[k], b = f[(k + 1) % 3], c = f[(k + 2) % 3];
      found[{std::min(a, b), std::max(a, b)}].away +=
          across(X[uz(c)] - X[uz(a)], (X[uz(b)] - X[uz(a)]).normalized());
    }
  }
  for (const Tet& t : tets) {
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = a + 1; b < 4; ++b) {
        const auto edge = found.find({std::min(t[a], t[b]), std::max(t[a], t[b])});
        if (edge == found.end()) continue;
        std::array<std::size_t, 2> other{};
        std::size_t n = 0;
        for (std::size_t c = 0; c < 4; ++c)
          if (c != a && c != b) other[n++] = c;
        const Vec3& x = X[uz(t[a])];
        const Vec3 axis = (X[uz(t[b])] - x).normalized();
        const double cosine =
            across(X[uz(t[other[0]])] - x, axis).dot(across(X[uz(t[other[1]])] - x, axis));
        edge->second.angle += std::acos(std::clamp(cosine, -1.0, 1.0));
      }
  }
  return found;
}

}  // namespace

CrackFront find_crack_front(const Model& model, const Body& body, std::span<const double> size) {
  CrackFront front;
  const auto& X = model.rest_position;
  std::vector<std::pair<Edge, Vec3>> edges;
  for (const auto& [edge, around] : edges_of_surface(model, body)) {
    if (around.angle < sharp) continue;
    const Vec3 ahead = -around.away;
    if (!(ahead.norm() > 0.0)) continue;
    edges.push_back({edge, ahead.normalized()});
    front.nodes.insert(front.nodes.end(), edge.begin(), edge.end());
  }
  std::sort(front.nodes.begin(), front.nodes.end());
  front.nodes.erase(std::unique(front.nodes.begin(), front.nodes.end()), front.nodes.end());
  const std::size_t count = front.nodes.size();
  front.width.assign(count, Vec3::Zero());
  std::vector<Vec3> tangent(count, Vec3::Zero());  // of either sense
  std::vector<int> degree(count, 0);
  const auto place = [&](Index node) {
    return static_cast<Index>(std::lower_bound(front.nodes.begin(), front.nodes.end(), node) -
                              front.nodes.begin());
  };
  for (const auto& [edge, ahead] : edges) {
    const Index a = place(edge[0]), b = place(edge[1]);
    front.edges.push_back({a, b});
    const Vec3 along = X[uz(edge[1])] - X[uz(edge[0])];
    for (const Index end : {a, b}) {
      front.width[uz(end)] += 0.5 * along.norm() * ahead;
      tangent[uz(end)] += turned_to(along, tangent[uz(end)]);
      ++degree[uz(end)];
    }
  }
  for (std::size_t s = 0; s < count; ++s) {
    const Index node = front.nodes[s];
    const double far = front_reach * size[uz(node - body.nodes.begin)];
    std::vector<Index> near;
    Vec3 width = Vec3::Zero(), along = tangent[s];
    for (std::size_t o = 0; o < count; ++o) {
      if ((X[uz(front.nodes[o])] - X[uz(node)]).norm() > far) continue;
      if (front.width[s].dot(front.width[o]) < 0.0) continue;  // the other side of a thin part
      near.push_back(static_cast<Index>(o));
      width += front.width[o];
      along += turned_to(tangent[o], tangent[s]);
    }
    front.near.push_back(std::move(near));
    front.along.push_back(along.normalized());
    front.ahead.push_back(across(width, front.along[s]));
    front.ends.push_back(degree[s] == 1);
  }
  return front;
}

}  // namespace sinew
