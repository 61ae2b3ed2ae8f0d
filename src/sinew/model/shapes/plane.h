// A plane: the half-space y <= 0.
#pragma once

#include <limits>

#include "sinew/model/shapes/surface_point.h"

namespace sinew::shapes {

struct Plane {
  static constexpr std::string_view word = "plane";
  static constexpr std::string_view needs = "center";
  static constexpr std::string_view takes = "normal rotation path";
  static Plane from(const Keys&) { return {}; }

  // The gap is y exactly, measured from the origin: a node that slides along the plane has no
  // rounding error in it.
  SurfacePoint surface(const Vec3& q) const {
    return {q.y(), Vec3::UnitY(), Vec3(q.x(), 0.0, q.z()), Vec3::Zero()};
  }
  std::optional<double> enters(const Vec3& q0, const Vec3& q1) const {
    if (!(q0.y() > 0.0) || q1.y() > 0.0) return {};
    return q0.y() / (q0.y() - q1.y());
  }
  Vec3 extent(const Mat3&) const { return Vec3::Constant(farthest()); }
  double farthest() const { return std::numeric_limits<double>::infinity(); }
  std::vector<Rod> rods(double) const { return {}; }  // flat: nodes are enough
  double smooth_to() const { return farthest(); }
  Vec3 sizes() const { return Vec3::Zero(); }
};

}  // namespace sinew::shapes
