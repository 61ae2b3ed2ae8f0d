#include "sinew/scene/glue.h"

#include <algorithm>
#include <cmath>

#include "sinew/contact/nearest.h"
#include "sinew/forces/ties.h"
#include "sinew/mesh/surface.h"

namespace sinew {
namespace {

constexpr double hardness = 10.0;  // of a tie, relative to the stiffness of the node

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

  // The triangle nearest to the point, and its distance [m].
  std::pair<const Place*, double> nearest(const Vec3& point) const {
    const Place* best = nullptr;
    double least = std::numeric_limits<double>::infinity();
    const auto look = [&](const Place& p) {  // false: none further out can be nearer
      const double distance =
          std::sqrt(nearest_on_triangle(point, x_[uz(p.triangle[0])], x_[uz(p.triangle[1])],
                                        x_[uz(p.triangle[2])])
                        .distance2);
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

// Stiffness of network and springs against the motion of one node [N/m] (nodes).
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

Surroundings glue_nodes(Model& model, const std::vector<Index>& nodes, const PlacedBody& to,
                        const std::vector<Index>& targets, double within, double stiffness) {
  Surroundings found;
  std::vector<Place> places = places_on(to, targets);
  found.triangles = static_cast<Index>(places.size());
  if (places.empty()) return found;
  const PlaceFinder finder(model.rest_position, std::move(places));
  const std::vector<double> resists = stiffness > 0.0 ? std::vector<double>{} : resistance(model);
  // Nodes on the surface count as touching it, independently of rounding.
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
