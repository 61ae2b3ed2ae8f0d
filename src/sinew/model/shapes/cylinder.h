// A cylinder with flat ends: all points within `radius` of the z axis, between -half and half.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sinew/model/shapes/surface_point.h"

namespace sinew::shapes {

struct Cylinder {
  static constexpr std::string_view word = "cylinder";
  static constexpr std::string_view needs = "center radius length";
  static constexpr std::string_view takes = "axis rotation path";
  static Cylinder from(const Keys& keys) { return {keys.radius, 0.5 * keys.length}; }

  double radius = 0.0;  // [m] > 0
  double half = 0.0;    // [m] > 0, of its length

  SurfacePoint surface(const Vec3& q) const {
    const double r = std::hypot(q.x(), q.y());
    const Vec3 out = r > 0.0 ? Vec3(q.x() / r, q.y() / r, 0.0) : Vec3(Vec3::UnitY());
    const double side = r - radius;
    const double end = std::abs(q.z()) - half;
    const Vec3 up(0.0, 0.0, q.z() < 0.0 ? -1.0 : 1.0);
    if (side <= 0.0 && end <= 0.0) {
      if (side >= end) return {side, out, radius * out + Vec3(0.0, 0.0, q.z())};
      return {end, up, Vec3(q.x(), q.y(), up.z() * half)};
    }
    const Vec3 nearest = std::min(r, radius) * out + Vec3(0.0, 0.0, std::clamp(q.z(), -half, half));
    if (side <= 0.0) return {end, up, nearest};
    if (end <= 0.0) return {side, out, nearest};
    const double distance = std::hypot(side, end);
    return {distance, (side / distance) * out + (end / distance) * up, nearest};
  }

  // The path is inside between its crossings of the side, x^2 + y^2 <= R^2, and of the ends.
  std::optional<double> enters(const Vec3& q0, const Vec3& q1) const {
    double in = -1.0;
    double out = 1.0;
    const double a = (q1 - q0).head<2>().squaredNorm();
    const double b = q0.head<2>().dot((q1 - q0).head<2>());
    const double c = q0.head<2>().squaredNorm() - radius * radius;
    const double root = b * b - a * c;
    if (c > 0.0) {
      if (b >= 0.0 || root < 0.0) return {};
      in = c / (-b + std::sqrt(root));  // without cancellation
    }
    if (a > 0.0) out = std::min(out, (-b + std::sqrt(root)) / a);
    const double displacement = q1.z() - q0.z();
    if (displacement == 0.0) {
      if (std::abs(q0.z()) > half) return {};
    } else {
      const double s = (-half - q0.z()) / displacement;
      const double t = (half - q0.z()) / displacement;
      in = std::max(in, std::min(s, t));
      out = std::min(out, std::max(s, t));
    }
    if (in < 0.0 || in > out) return {};
    return in;
  }

  Vec3 extent(const Mat3& turn) const {
    const Vec3 axis = turn.col(2);
    const Vec3 across = (Vec3::Ones() - axis.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
    return half * axis.cwiseAbs() + radius * across;
  }
  double farthest() const { return std::hypot(radius, half); }

  // The side, if its radius is small enough to slip between nodes, and both rims. A rim is a
  // polygon of rods, rounded by a tenth of the smaller of diameter and length. The rod of the side
  // ends at the depth of the rims, so a triangle that penetrates slightly through a flat end does
  // not cut its axis.
  std::vector<Rod> rods(double longest_edge) const {
    constexpr int corners = 16;  // between them the polygon is inside by 2 % of the radius
    std::vector<Rod> all;
    const double rounding = 0.2 * std::min(radius, half);
    const Vec3 end(0.0, 0.0, half - rounding);
    if (radius < 2.0 * longest_edge) all.push_back({-end, end, radius});
    const auto corner = [&](int k, double up) {
      const double angle = 2.0 * std::numbers::pi * (k % corners) / corners;
      return Vec3((radius - rounding) * std::cos(angle), (radius - rounding) * std::sin(angle),
                  up * (half - rounding));
    };
    for (const double up : {-1.0, 1.0}) {
      for (int k = 0; k < corners; ++k) all.push_back({corner(k, up), corner(k, up), rounding});
      for (int k = 0; k < corners; ++k) all.push_back({corner(k, up), corner(k + 1, up), rounding});
    }
    return all;
  }
  double smooth_to() const { return 0.0; }  // rims are sharp
  Vec3 sizes() const { return Vec3(radius, radius, half); }
};

}  // namespace sinew::shapes
