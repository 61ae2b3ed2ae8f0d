// The nearest points of a segment and a triangle. Pure functions on plain values.
// C. Ericson, Real-Time Collision Detection, Morgan Kaufmann 2005, sections 5.1.5, 5.1.9, 5.1.10.
#pragma once

#include <algorithm>
#include <array>

#include "sinew/base/vec.h"

namespace sinew {

using Corners = std::array<Vec3, 3>;

// Barycentric weights of the point of the triangle that is nearest to p. If that point is on an
// edge or at a corner, the other weights are exactly zero.
inline Vec3 nearest_in_triangle(const Vec3& p, const Corners& t) {
  const Vec3 ab = t[1] - t[0];
  const Vec3 ac = t[2] - t[0];
  const Vec3 ap = p - t[0];
  const double d1 = ab.dot(ap);
  const double d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return Vec3(1, 0, 0);
  const Vec3 bp = p - t[1];
  const double d3 = ab.dot(bp);
  const double d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return Vec3(0, 1, 0);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 && d1 > d3) return Vec3(-d3, d1, 0) / (d1 - d3);
  const Vec3 cp = p - t[2];
  const double d5 = ab.dot(cp);
  const double d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return Vec3(0, 0, 1);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 && d2 > d6) return Vec3(-d6, 0, d2) / (d2 - d6);
  const double va = d3 * d6 - d5 * d4;
  const double e1 = d4 - d3;
  const double e2 = d5 - d6;
  if (va <= 0.0 && e1 >= 0.0 && e2 >= 0.0 && e1 + e2 > 0.0) return Vec3(0, e2, e1) / (e1 + e2);
  const double sum = va + vb + vc;
  if (sum > 0.0) return Vec3(va, vb, vc) / sum;
  return Vec3(1, 0, 0);  // a triangle without area: one of its corners; callers test the edges too
}

// Shares s, t in [0, 1] of the nearest points a0 + s (a1 - a0), b0 + t (b1 - b0) of two segments.
inline std::array<double, 2> nearest_of_segments(const Vec3& a0, const Vec3& a1, const Vec3& b0,
                                                 const Vec3& b1) {
  const Vec3 d1 = a1 - a0;
  const Vec3 d2 = b1 - b0;
  const Vec3 r = a0 - b0;
  const double a = d1.squaredNorm();
  const double e = d2.squaredNorm();
  const double f = d2.dot(r);
  const auto share = [](double x) { return std::clamp(x, 0.0, 1.0); };
  if (a == 0.0 && e == 0.0) return {0.0, 0.0};
  if (a == 0.0) return {0.0, share(f / e)};
  const double c = d1.dot(r);
  if (e == 0.0) return {share(-c / a), 0.0};
  const double b = d1.dot(d2);
  const double determinant = a * e - b * b;
  double s = determinant > 1e-14 * a * e ? share((b * f - c * e) / determinant) : 0.0;
  double t = (b * s + f) / e;
  if (t < 0.0 || t > 1.0) {
    t = share(t);
    s = share((b * t - c) / a);
  }
  return {s, t};
}

// The nearest points of the segment from a to b and a triangle.
struct NearestPair {
  double share = 0.0;          // along the segment from a to b [-]
  Vec3 weight = Vec3::Zero();  // barycentric, of the triangle's point [-]
  Vec3 on_segment = Vec3::Zero();
  Vec3 on_triangle = Vec3::Zero();
  double distance = 0.0;  // 0: the segment passes through the triangle
};

inline NearestPair nearest_of_segment_and_triangle(const Vec3& a, const Vec3& b, const Corners& t) {
  NearestPair best;
  best.distance = -1.0;
  const auto consider = [&](double share, const Vec3& weight) {
    NearestPair p;
    p.share = share;
    p.weight = weight;
    p.on_segment = a + share * (b - a);
    p.on_triangle = weight[0] * t[0] + weight[1] * t[1] + weight[2] * t[2];
    p.distance = (p.on_triangle - p.on_segment).norm();
    if (best.distance < 0.0 || p.distance < best.distance) best = p;
  };
  consider(0.0, nearest_in_triangle(a, t));
  if (a == b) return best;
  consider(1.0, nearest_in_triangle(b, t));
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const auto [s, u] =
        nearest_of_segments(a, b, t[static_cast<std::size_t>(i)], t[static_cast<std::size_t>(j)]);
    Vec3 weight = Vec3::Zero();
    weight[i] = 1.0 - u;
    weight[j] = u;
    consider(s, weight);
  }
  const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const double height_a = normal.dot(a - t[0]);
  const double height_b = normal.dot(b - t[0]);
  if (height_a * height_b < 0.0) {
    const double s = height_a / (height_a - height_b);
    const Vec3 p = a + s * (b - a);
    const Vec3 weight(normal.dot((t[1] - p).cross(t[2] - p)),
                      normal.dot((t[2] - p).cross(t[0] - p)),
                      normal.dot((t[0] - p).cross(t[1] - p)));
    if (weight.minCoeff() >= 0.0) {
      consider(s, weight / weight.sum());
      best.distance = 0.0;
    }
  }
  return best;
}

}  // namespace sinew
