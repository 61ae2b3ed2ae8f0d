// A capsule: all points within `radius` of the segment from (0, 0, -half) to (0, 0, half).
#pragma once

#include <algorithm>

#include "sinew/model/shapes/round.h"

namespace sinew::shapes {

struct Capsule {
  static constexpr std::string_view word = "capsule";
  static constexpr std::string_view needs = "center radius length";
  static constexpr std::string_view takes = "axis rotation path";
  static Capsule from(const Keys& keys) { return {keys.radius, 0.5 * keys.length}; }

  double radius = 0.0;  // [m] > 0
  double half = 0.0;    // [m] > 0, of the segment

  SurfacePoint surface(const Vec3& q) const {
    return ball_surface(q, Vec3(0.0, 0.0, std::clamp(q.z(), -half, half)), radius);
  }
  std::optional<double> enters(const Vec3& q0, const Vec3& q1) const {
    std::optional<double> first;
    if (surface(q0).distance <= 0.0) return first;
    const auto consider = [&](std::optional<double> s) {
      if (s && (!first || *s < *first)) first = s;
    };
    const auto side = enters_round(q0, q1, Vec3::Zero(), radius, Vec3(1.0, 1.0, 0.0));
    if (side && std::abs(q0.z() + *side * (q1.z() - q0.z())) <= half) consider(side);
    for (const double end : {-half, half})
      consider(enters_round(q0, q1, Vec3(0.0, 0.0, end), radius));
    return first;
  }
  Vec3 extent(const Mat3& turn) const {
    return turn.col(2).cwiseAbs() * half + Vec3::Constant(radius);
  }
  double farthest() const { return radius + half; }
  // Both ends and the side, if the radius is small enough to slip between nodes (see Sphere::rods).
  std::vector<Rod> rods(double longest_edge) const {
    if (radius >= 2.0 * longest_edge) return {};
    const Vec3 end(0.0, 0.0, half);
    std::vector<Rod> out = {{-end, -end, radius}};
    if (half > 0.0) {
      out.push_back({end, end, radius});
      out.push_back({-end, end, radius});
    }
    return out;
  }
  double smooth_to() const { return 0.5 * radius; }
  Vec3 sizes() const { return Vec3(radius, radius, half); }
};

}  // namespace sinew::shapes
