// A box: |x| <= half.x(), |y| <= half.y(), |z| <= half.z().
#pragma once

#include <algorithm>
#include <cmath>

#include "sinew/model/shapes/surface_point.h"

namespace sinew::shapes {

struct Box {
  static constexpr std::string_view word = "box";
  static constexpr std::string_view needs = "center size";
  static constexpr std::string_view takes = "rotation path";
  static Box from(const Keys& keys) { return {0.5 * keys.size}; }

  Vec3 half = Vec3::Zero();  // [m] > 0, half sides

  SurfacePoint surface(const Vec3& q) const {
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
  std::optional<double> enters(const Vec3& q0, const Vec3& q1) const {
    double in = -1.0;
    double out = 1.0;
    for (int a = 0; a < 3; ++a) {
      const double displacement = q1[a] - q0[a];
      if (displacement == 0.0) {
        if (std::abs(q0[a]) > half[a]) return {};
        continue;
      }
      const double s = (-half[a] - q0[a]) / displacement;
      const double t = (half[a] - q0[a]) / displacement;
      in = std::max(in, std::min(s, t));
      out = std::min(out, std::max(s, t));
    }
    if (in < 0.0 || in > out) return {};
    return in;
  }
  Vec3 extent(const Mat3& turn) const { return turn.cwiseAbs() * half; }
  double farthest() const { return half.norm(); }
  // Its corners and edges, rounded by a tenth of its smallest side.
  std::vector<Rod> rods(double) const {
    const double radius = 0.2 * half.minCoeff();
    const Vec3 in = half - Vec3::Constant(radius);
    const auto corner = [&](int bits) {
      return Vec3((bits & 1) != 0 ? in.x() : -in.x(), (bits & 2) != 0 ? in.y() : -in.y(),
                  (bits & 4) != 0 ? in.z() : -in.z());
    };
    std::vector<Rod> out;
    for (int c = 0; c < 8; ++c) out.push_back({corner(c), corner(c), radius});
    for (int c = 0; c < 8; ++c)
      for (const int axis : {1, 2, 4})
        if ((c & axis) == 0) out.push_back({corner(c), corner(c | axis), radius});
    return out;
  }
  double smooth_to() const { return 0.0; }
  Vec3 sizes() const { return half; }
};

}  // namespace sinew::shapes
