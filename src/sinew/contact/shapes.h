// Signed distance, normal and nearest surface point of simple shapes in their own frame, and where
// a segment enters them. Pure functions on plain values; every shape is convex.
//
// Inside, the normal shows the shortest way out. Where several are equally short (the centre of a
// sphere, the axis of a capsule, the mid planes of a box) the choice is fixed.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "sinew/base/vec.h"

namespace sinew {

// The surface as seen from a point.
struct SurfacePoint {
  double distance = 0.0;        // [m] < 0: the point is inside
  Vec3 normal = Vec3::UnitY();  // [-] unit, outwards, of the surface at `nearest`
  Vec3 nearest = Vec3::Zero();  // [m] on the surface
  Vec3 anchor = nearest;        // [m] on its tangent plane there, from where gaps are measured
};

// The half-space y <= 0. Gaps are measured from its origin, so that a node at rest does not move
// it.
inline SurfacePoint plane_surface(const Vec3& q) {
  return {q.y(), Vec3::UnitY(), Vec3(q.x(), 0.0, q.z()), Vec3::Zero()};
}

// The ball of radius R about `middle`: distance |q - middle| - R.
inline SurfacePoint ball_surface(const Vec3& q, const Vec3& middle, double radius) {
  const Vec3 r = q - middle;
  const double length = r.norm();
  const Vec3 n = length > 0.0 ? Vec3(r / length) : Vec3(Vec3::UnitY());
  return {length - radius, n, middle + radius * n};
}

inline SurfacePoint sphere_surface(const Vec3& q, double radius) {
  return ball_surface(q, Vec3::Zero(), radius);
}

// What is within `radius` of the segment from (0, 0, -half) to (0, 0, half).
inline SurfacePoint capsule_surface(const Vec3& q, double half, double radius) {
  return ball_surface(q, Vec3(0.0, 0.0, std::clamp(q.z(), -half, half)), radius);
}

// The box |x| <= half.x(), |y| <= half.y(), |z| <= half.z().
inline SurfacePoint box_surface(const Vec3& q, const Vec3& half) {
  const Vec3 over = q.cwiseAbs() - half;
  int axis = 0;
  const double most = over.maxCoeff(&axis);
  if (most <= 0.0) {
    Vec3 n = Vec3::Zero();
    n[axis] = q[axis] < 0.0 ? -1.0 : 1.0;
    Vec3 nearest = q;
    nearest[axis] = n[axis] * half[axis];
    return {most, n, nearest};
  }
  const Vec3 nearest = q.cwiseMax(-half).cwiseMin(half);
  const Vec3 out = q - nearest;
  const double distance = out.norm();
  return {distance, out / distance, nearest};
}

// The share of the way from q0, which is outside, to q1 at which a shape is entered; none where it
// is not.
inline std::optional<double> enters_plane(const Vec3& q0, const Vec3& q1) {
  if (!(q0.y() > 0.0) || q1.y() > 0.0) return {};
  return q0.y() / (q0.y() - q1.y());
}

// |q0 + s (q1 - q0) - middle|^2 = R^2, the smaller root. `mask` leaves out directions: (1, 1, 0) is
// a cylinder along z.
inline std::optional<double> enters_round(const Vec3& q0, const Vec3& q1, const Vec3& middle,
                                          double radius, const Vec3& mask = Vec3::Ones()) {
  const Vec3 r = (q0 - middle).cwiseProduct(mask);
  const Vec3 way = (q1 - q0).cwiseProduct(mask);
  const double a = way.squaredNorm();
  const double b = r.dot(way);
  const double c = r.squaredNorm() - radius * radius;
  const double root = b * b - a * c;
  if (b >= 0.0 || c <= 0.0 || root < 0.0) return {};
  const double s = c / (-b + std::sqrt(root));  // without cancellation
  return s <= 1.0 ? std::optional(s) : std::nullopt;
}

inline std::optional<double> enters_sphere(const Vec3& q0, const Vec3& q1, double radius) {
  return enters_round(q0, q1, Vec3::Zero(), radius);
}

inline std::optional<double> enters_capsule(const Vec3& q0, const Vec3& q1, double half,
                                            double radius) {
  std::optional<double> first;
  if (capsule_surface(q0, half, radius).distance <= 0.0) return first;
  const auto consider = [&](std::optional<double> s) {
    if (s && (!first || *s < *first)) first = s;
  };
  const auto side = enters_round(q0, q1, Vec3::Zero(), radius, Vec3(1.0, 1.0, 0.0));
  if (side && std::abs(q0.z() + *side * (q1.z() - q0.z())) <= half) consider(side);
  for (const double end : {-half, half})
    consider(enters_round(q0, q1, Vec3(0.0, 0.0, end), radius));
  return first;
}

inline std::optional<double> enters_box(const Vec3& q0, const Vec3& q1, const Vec3& half) {
  double in = -1.0;
  double out = 1.0;
  for (int a = 0; a < 3; ++a) {
    const double way = q1[a] - q0[a];
    if (way == 0.0) {
      if (std::abs(q0[a]) > half[a]) return {};
      continue;
    }
    const double s = (-half[a] - q0[a]) / way;
    const double t = (half[a] - q0[a]) / way;
    in = std::max(in, std::min(s, t));
    out = std::min(out, std::max(s, t));
  }
  if (in < 0.0 || in > out) return {};
  return in;
}

}  // namespace sinew
