// Functions that round shapes share: the distance from a ball, and the point where a straight path
// enters a ball or an infinite cylinder.
#pragma once

#include <cmath>
#include <optional>

#include "sinew/model/shapes/surface_point.h"

namespace sinew::shapes {

// The ball of radius R about `middle`: distance |q - middle| - R.
inline SurfacePoint ball_surface(const Vec3& q, const Vec3& middle, double radius) {
  const Vec3 r = q - middle;
  const double length = r.norm();
  const Vec3 n = length > 0.0 ? Vec3(r / length) : Vec3(Vec3::UnitY());
  return {length - radius, n, middle + radius * n};
}

// The share of the path from q0, which is outside, to q1 at which it enters the ball; none if it
// does not. |q0 + s (q1 - q0) - middle|^2 = R^2, the smaller root. `mask` removes directions: (1,
// 1, 0) is a cylinder along z.
inline std::optional<double> enters_round(const Vec3& q0, const Vec3& q1, const Vec3& middle,
                                          double radius, const Vec3& mask = Vec3::Ones()) {
  const Vec3 r = (q0 - middle).cwiseProduct(mask);
  const Vec3 displacement = (q1 - q0).cwiseProduct(mask);
  const double a = displacement.squaredNorm();
  const double b = r.dot(displacement);
  const double c = r.squaredNorm() - radius * radius;
  const double root = b * b - a * c;
  if (b >= 0.0 || c <= 0.0 || root < 0.0) return {};
  const double s = c / (-b + std::sqrt(root));  // without cancellation
  return s <= 1.0 ? std::optional(s) : std::nullopt;
}

}  // namespace sinew::shapes
