// The nearest points of two features of triangle meshes: pure functions on points.
// Ericson, Real-Time Collision Detection (2005), chapter 5.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "sinew/base/vec.h"

namespace sinew {

// v / |v|; 0 if v is zero.
inline Vec3 unit(const Vec3& v) {
  const double n = v.norm();
  return n > 0.0 ? Vec3(v / n) : Vec3(Vec3::Zero());
}

// The parameter in [0, 1] of the point of the segment a b that is nearest to p; 0 if a = b.
inline double nearest_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 e = b - a;
  const double length2 = e.squaredNorm();
  return length2 > 0.0 ? std::clamp(e.dot(p - a) / length2, 0.0, 1.0) : 0.0;
}

// The point of a triangle that is nearest to p, as weights of the corners. The weights sum to 1;
// corners that do not contribute have weight exactly 0 (two of them if the point is a corner, one
// if it is on an edge).
struct OnTriangle {
  std::array<double, 3> weight = {1.0, 0.0, 0.0};
  Vec3 point = Vec3::Zero();
  double distance2 = 0.0;  // [m2]
};

inline OnTriangle on_edge(const Vec3& p, const std::array<const Vec3*, 3>& x, std::size_t i,
                          std::size_t j) {
  const double s = nearest_on_segment(p, *x[i], *x[j]);
  OnTriangle r;
  r.weight = {0.0, 0.0, 0.0};
  r.weight[i] = 1.0 - s;
  r.weight[j] = s;
  r.point = s == 1.0 ? *x[j] : *x[i] + s * (*x[j] - *x[i]);
  r.distance2 = (p - r.point).squaredNorm();
  return r;
}

// A triangle without area is treated as its edges.
inline OnTriangle nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const Vec3 ap = p - a;
  const Vec3 n = ab.cross(ac);
  const double n2 = n.squaredNorm();
  const double scale = std::max(ab.squaredNorm(), ac.squaredNorm());
  if (n2 > 1e-20 * scale * scale) {
    const double wb = ap.cross(ac).dot(n) / n2;
    const double wc = ab.cross(ap).dot(n) / n2;
    const double wa = 1.0 - wb - wc;
    if (wa > 0.0 && wb > 0.0 && wc > 0.0) {
      OnTriangle r;
      r.weight = {wa, wb, wc};
      r.point = a + wb * ab + wc * ac;
      const double d = ap.dot(n);
      r.distance2 = d * d / n2;
      return r;
    }
  }
  const std::array<const Vec3*, 3> x = {&a, &b, &c};
  OnTriangle best = on_edge(p, x, 0, 1);
  const OnTriangle second = on_edge(p, x, 1, 2);
  if (second.distance2 < best.distance2) best = second;
  const OnTriangle third = on_edge(p, x, 2, 0);
  if (third.distance2 < best.distance2) best = third;
  return best;
}

// The points a + s (b - a) and c + t (d - c) at which two lines are nearest to each other. s and t
// are not clamped; `parallel`: the lines have no unique nearest pair.
struct OnLines {
  double s = 0.0;
  double t = 0.0;
  bool parallel = true;
};

inline OnLines nearest_on_lines(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a;
  const Vec3 v = d - c;
  const Vec3 r = a - c;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v);
  const double area2 = uu * vv - uv * uv;  // |u x v|^2
  OnLines on;
  if (!(area2 > 1e-6 * uu * vv)) return on;  // within 0.06 degrees
  on.s = (uv * v.dot(r) - vv * u.dot(r)) / area2;
  on.t = (uu * v.dot(r) - uv * u.dot(r)) / area2;
  on.parallel = false;
  return on;
}

// The distance of two segments.
inline double segments_distance(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const auto away = [](const Vec3& p, const Vec3& e, const Vec3& f) {
    return (p - e - nearest_on_segment(p, e, f) * (f - e)).norm();
  };
  const double ends =
      std::min(std::min(away(a, c, d), away(b, c, d)), std::min(away(c, a, b), away(d, a, b)));
  const OnLines on = nearest_on_lines(a, b, c, d);
  if (on.parallel || on.s < 0.0 || on.s > 1.0 || on.t < 0.0 || on.t > 1.0) return ends;
  return std::min(ends, (a + on.s * (b - a) - c - on.t * (d - c)).norm());
}

}  // namespace sinew
