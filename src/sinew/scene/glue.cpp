#include "sinew/scene/glue.h"

#include <algorithm>
#include <cmath>

#include "sinew/forces/ties.h"
#include "sinew/mesh/surface.h"

namespace sinew {
namespace {

constexpr double hardness = 10.0;  // of a tie, against what the node resists with

struct Place {
  Triangle triangle = {};  // node ids of the Model
  Tet tet = {};
};

// Triangles of a surface, searched from a point outwards along x.
class PlaceFinder {
 public:
  PlaceFinder(const std::vector<Vec3>& x, std::vector<Place> places)
      : x_(x), places_(std::move(places)) {
    std::stable_sort(places_.begin(), places_.end(), [&](const Place& a, const Place& b) {
      return middle(a.triangle) < middle(b.triangle);
    });
    for (const Place& p : places_) {
      for (const Index node : p.triangle) {
        reach_ = std::max(reach_, std::abs(x_[uz(node)].x() - middle(p.triangle)));
      }
    }
  }

  // The triangle nearest to the point, and how far it is [m].
  std::pair<const Place*, double> nearest(const Vec3& point) const {
    const Place* best = nullptr;
    double least = std::numeric_limits<double>::infinity();
    const auto look = [&](const Place& p) {  // false: none further out can be nearer
      const Vec3 there = nearest_on_triangle(point, x_[uz(p.triangle[0])], x_[uz(p.triangle[1])],
                                             x_[uz(p.triangle[2])]);
      const double distance = (there - point).norm();
      if (distance < least) {
        best = &p;
        least = distance;
      }
      return std::abs(middle(p.triangle) - point.x()) - reach_ <= least;
    };
    const auto start =
        std::lower_bound(places_.begin(), places_.end(), point.x(),
                         [&](const Place& p, double at) { return middle(p.triangle) < at; });
    for (auto up = start; up != places_.end() && look(*up); ++up) {
    }
    for (auto down = start; down != places_.begin() && look(*(down - 1)); --down) {
    }
    return {best, least};
  }

 private:
  double middle(const Triangle& t) const {
    return (x_[uz(t[0])].x() + x_[uz(t[1])].x() + x_[uz(t[2])].x()) / 3.0;
  }

  const std::vector<Vec3>& x_;
  std::vector<Place> places_;  // by the middle's x
  double reach_ = 0.0;         // [m] of a triangle along x, to either side of its middle
};

std::vector<Place> places_on(const PlacedBody& to, const std::vector<Index>& targets) {
  std::vector<bool> chosen(to.mesh.nodes.size(), false);
  for (const Index node : targets) chosen[uz(node - to.first_node)] = true;
  const Surface surface = build_surface(to.mesh.tets, to.mesh.node_count());
  std::vector<Place> places;
  for (std::size_t k = 0; k < surface.triangles.size(); ++k) {
    Place place{surface.triangles[k], to.mesh.tets[uz(surface.tets[k])]};
    const Triangle& t = place.triangle;
    if (!chosen[uz(t[0])] || !chosen[uz(t[1])] || !chosen[uz(t[2])]) continue;
    for (Index& node : place.triangle) node += to.first_node;
    for (Index& node : place.tet) node += to.first_node;
    places.push_back(place);
  }
  return places;
}

// What network and springs resist with where one node moves alone [N/m] (nodes).
std::vector<double> resistance(const Model& model) {
  std::vector<double> k(model.rest_position.size(), 0.0);
  for (std::size_t i = 0; i + 1 < model.network_start.size(); ++i) {
    for (auto e = uz(model.network_start[i]); e < uz(model.network_start[i + 1]); ++e) {
      k[i] += model.network_stiffness[e];
    }
  }
  for (std::size_t s = 0; s < uz(model.first_attachment); ++s) {
    for (const Index end : model.springs[s]) k[uz(end)] += model.stiffness[s];
  }
  return k;
}

}  // namespace

// By the regions of the plane that the triangle's corners, edges and inside are nearest to
// (Ericson, Real-Time Collision Detection, 5.1.5).
Vec3 nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const double d1 = ab.dot(p - a);
  const double d2 = ac.dot(p - a);
  if (d1 <= 0.0 && d2 <= 0.0) return a;
  const double d3 = ab.dot(p - b);
  const double d4 = ac.dot(p - b);
  if (d3 >= 0.0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + d1 / (d1 - d3) * ab;
  const double d5 = ab.dot(p - c);
  const double d6 = ac.dot(p - c);
  if (d6 >= 0.0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 >= d3 && d5 >= d6) {
    return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  }
  const double scale = 1.0 / (va + vb + vc);
  return a + vb * scale * ab + vc * scale * ac;
}

Surroundings glue_nodes(Model& model, const std::vector<Index>& nodes, const PlacedBody& to,
                        const std::vector<Index>& targets, double within, double stiffness) {
  Surroundings found;
  std::vector<Place> places = places_on(to, targets);
  found.triangles = static_cast<Index>(places.size());
  if (places.empty()) return found;
  const PlaceFinder finder(model.rest_position, std::move(places));
  const std::vector<double> resists = stiffness > 0.0 ? std::vector<double>{} : resistance(model);
  // Nodes that lie on the surface count as touching it whatever rounding does.
  const double reach = within + 1e-9 * to.diagonal();
  for (const Index node : nodes) {
    const auto [place, distance] = finder.nearest(model.rest_position[uz(node)]);
    found.nearest = std::min(found.nearest, distance);
    if (distance > reach) continue;
    double k = stiffness;
    if (k == 0.0) {
      const Triangle& t = place->triangle;
      const double there = (resists[uz(t[0])] + resists[uz(t[1])] + resists[uz(t[2])]) / 3.0;
      k = hardness * std::min(resists[uz(node)], there);
    }
    add_tie(model, node, place->tet, k);
    ++found.tied;
  }
  return found;
}

}  // namespace sinew
