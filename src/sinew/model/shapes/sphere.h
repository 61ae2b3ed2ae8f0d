// A sphere: all points within `radius` of the origin. The only shape that can be soft.
#pragma once

#include "sinew/model/shapes/round.h"

namespace sinew::shapes {

struct Sphere {
  static constexpr std::string_view word = "sphere";
  static constexpr std::string_view needs = "center radius";
  static constexpr std::string_view takes = "stiffness path";
  static Sphere from(const Keys& keys) { return {keys.radius}; }

  double radius = 0.0;  // [m] > 0

  SurfacePoint surface(const Vec3& q) const { return ball_surface(q, Vec3::Zero(), radius); }
  std::optional<double> enters(const Vec3& q0, const Vec3& q1) const {
    return enters_round(q0, q1, Vec3::Zero(), radius);
  }
  Vec3 extent(const Mat3&) const { return Vec3::Constant(radius); }
  double farthest() const { return radius; }
  // No rod for a larger sphere: it enters between the two nodes of an edge by at most 9 % of the
  // edge's length, so the contacts of nodes are enough.
  std::vector<Rod> rods(double longest_edge) const {
    if (radius >= 2.0 * longest_edge) return {};
    return {{Vec3::Zero(), Vec3::Zero(), radius}};
  }
  double smooth_to() const { return 0.5 * radius; }
  Vec3 sizes() const { return Vec3::Constant(radius); }
};

}  // namespace sinew::shapes
