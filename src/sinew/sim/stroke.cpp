#include "sinew/sim/stroke.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sinew/mesh/tet_mesh.h"

namespace sinew::sim {
namespace {

std::array<double, 4> barycentric(const std::vector<Vec3>& x, const Tet& t, const Vec3& p) {
  std::array<double, 4> share{};
  const double whole = signed_volume(x, t);
  for (std::size_t k = 0; k < 4; ++k) {
    std::array<Vec3, 4> c;
    for (std::size_t i = 0; i < 4; ++i) c[i] = i == k ? p : x[uz(t[i])];
    share[k] = signed_volume(c[0], c[1], c[2], c[3]) / whole;
  }
  return share;
}

}  // namespace

RestPlaces::RestPlaces(const Model& model, const Body& body, const std::vector<Vec3>& x)
    : model_(model), body_(body), x_(x) {
  for (Index t = body.tets.begin; t < body.tets.end; ++t) {
    box_.push_back(box_around(model.tets[uz(t)], x));
    Vec3 centre = Vec3::Zero();
    for (const Index node : model.tets[uz(t)]) centre += 0.25 * x[uz(node)];
    centre_.push_back(centre);
  }
}

Vec3 RestPlaces::of(const Vec3& p) const {
  constexpr double slack = -1e-9;
  const auto place = [&](Index t, const std::array<double, 4>& share) {
    Vec3 out = Vec3::Zero();
    for (std::size_t k = 0; k < 4; ++k)
      out += share[k] * model_.rest_position[uz(model_.tets[uz(t)][k])];
    return out;
  };
  for (std::size_t i = 0; i < box_.size(); ++i) {
    if (!((p.array() >= box_[i].lo.array()).all() && (p.array() <= box_[i].hi.array()).all()))
      continue;
    const Index t = body_.tets.begin + static_cast<Index>(i);
    const auto share = barycentric(x_, model_.tets[uz(t)], p);
    if (*std::min_element(share.begin(), share.end()) >= slack) return place(t, share);
  }
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < centre_.size(); ++i) {
    const double distance = (p - centre_[i]).squaredNorm();
    if (distance >= least) continue;
    const Index t = body_.tets.begin + static_cast<Index>(i);
    if (!(signed_volume(x_, model_.tets[uz(t)]) > 0.0)) continue;
    least = distance;
    nearest = i;
  }
  const Index t = body_.tets.begin + static_cast<Index>(nearest);
  return place(t, barycentric(x_, model_.tets[uz(t)], p));
}

Box Stroke::add(std::vector<Vec3> edge) {
  Box box;
  const auto first = static_cast<Index>(surface.vertices.size());
  const auto count = static_cast<Index>(edge.size());
  for (const Vec3& p : edge) box.add(p);
  surface.vertices.insert(surface.vertices.end(), edge.begin(), edge.end());
  if (!last.empty()) {
    for (const Vec3& p : last) box.add(p);
    for (Index i = 0; i + 1 < count; ++i) {
      const Index a = first - count + i, b = first + i;
      surface.triangles.push_back({a, a + 1, b});
      surface.triangles.push_back({a + 1, b + 1, b});
    }
  }
  last = std::move(edge);
  return box;
}

std::vector<Vec3> points_on_edge(const Vec3& heel, const Vec3& tip, double spacing) {
  constexpr double most = 32.0;
  const double wish = std::ceil((tip - heel).norm() / spacing);
  const int parts = static_cast<int>(std::clamp(wish, 1.0, most));  // also if spacing is 0
  std::vector<Vec3> points;
  for (int i = 0; i <= parts; ++i)
    points.push_back(heel + (tip - heel) * (static_cast<double>(i) / parts));
  return points;
}

}  // namespace sinew::sim
