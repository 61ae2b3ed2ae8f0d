// The time of impact of features that move along straight lines in a step: the roots of the
// coplanarity cubic (Provot 1997; Bridson, Fedkiw, Anderson 2002).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "sinew/base/vec.h"

namespace sinew {

// A cubic c0 + c1 t + c2 t^2 + c3 t^3.
struct Cubic {
  std::array<double, 4> c = {};
  double at(double t) const { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); }
};

// det(u0 + t du, v0 + t dv, w0 + t dw): the coplanarity of three moving edges.
inline Cubic moving_determinant(const Vec3& u, const Vec3& du, const Vec3& v, const Vec3& dv,
                                const Vec3& w, const Vec3& dw) {
  const Vec3 n0 = v.cross(w);
  const Vec3 n1 = v.cross(dw) + dv.cross(w);
  const Vec3 n2 = dv.cross(dw);
  return {{u.dot(n0), u.dot(n1) + du.dot(n0), u.dot(n2) + du.dot(n1), du.dot(n2)}};
}

// The roots in [0, 1] at which the cubic changes its sign (or starts at 0), ascending. Each
// monotonic piece is searched by Newton's method with bisection, to the last bits.
struct Roots {
  std::array<double, 4> t = {};
  int count = 0;
};

inline Roots crossings(const Cubic& f) {
  // The extrema: c1 + 2 c2 t + 3 c3 t^2 = 0.
  std::array<double, 4> cut = {0.0, 1.0, 1.0, 1.0};
  int pieces = 1;
  const double a = 3.0 * f.c[3], b = f.c[2], c = f.c[1];  // a t^2 + 2 b t + c
  const double disc = b * b - a * c;
  if (disc > 0.0) {
    const double q = -(b + std::copysign(std::sqrt(disc), b));
    std::array<double, 2> turn = {a != 0.0 ? q / a : 2.0, q != 0.0 ? c / q : 2.0};
    if (turn[1] < turn[0]) std::swap(turn[0], turn[1]);
    for (const double t : turn) {
      if (t > 0.0 && t < 1.0) cut[static_cast<std::size_t>(pieces++)] = t;
    }
    cut[static_cast<std::size_t>(pieces)] = 1.0;
  }
  Roots roots;
  for (int i = 0; i < pieces; ++i) {
    double lo = cut[static_cast<std::size_t>(i)], hi = cut[static_cast<std::size_t>(i) + 1];
    const double flo = f.at(lo), fhi = f.at(hi);
    if (!((flo >= 0.0 && fhi < 0.0) || (flo <= 0.0 && fhi > 0.0))) continue;
    const bool falls = fhi < 0.0;
    double t = lo + (hi - lo) * (flo / (flo - fhi));  // secant as the first guess
    for (int n = 0; n < 100 && lo < t && t < hi; ++n) {
      const double ft = f.at(t);
      if ((ft < 0.0) == falls && ft != 0.0) {
        hi = t;
      } else {
        lo = t;
      }
      // Newton's step if it stays inside, else half the interval.
      const double slope = f.c[1] + t * (2.0 * f.c[2] + 3.0 * f.c[3] * t);
      const double next = slope != 0.0 ? t - ft / slope : lo;
      if (std::abs(next - t) <= 1e-15) break;
      t = next > lo && next < hi && n % 4 != 3 ? next : 0.5 * (lo + hi);
    }
    roots.t[static_cast<std::size_t>(roots.count++)] = std::clamp(t, 0.0, 1.0);
  }
  return roots;
}

// A node p and a triangle a b c, from their positions at the start and the end of a step.
struct NodeAndTriangle {
  Vec3 p0, a0, b0, c0;
  Vec3 p1, a1, b1, c1;
};

// The motion of four nodes, p0 ... c0 in this order.
inline NodeAndTriangle motion_of(Index p, Index a, Index b, Index c, const std::vector<Vec3>& from,
                                 const std::vector<Vec3>& to) {
  return {from[uz(p)], from[uz(a)], from[uz(b)], from[uz(c)],
          to[uz(p)],   to[uz(a)],   to[uz(b)],   to[uz(c)]};
}

// The first time at which p passes through the triangle from its front to its back.
struct TimeOfImpact {
  bool found = false;
  double time = 0.0;                  // [-] in [0, 1]
  std::array<double, 3> weight = {};  // of the triangle's corners, or s (0) and t (1) of edges
  Vec3 normal = Vec3::Zero();         // [-] unit, at that time
};

inline Vec3 between(const Vec3& from, const Vec3& to, double t) {
  return from + t * (to - from);
}

inline TimeOfImpact impact_of_node(const NodeAndTriangle& m) {
  const Vec3 u = m.p0 - m.a0, du = m.p1 - m.a1 - u;
  const Vec3 v = m.b0 - m.a0, dv = m.b1 - m.a1 - v;
  const Vec3 w = m.c0 - m.a0, dw = m.c1 - m.a1 - w;
  const Cubic f = moving_determinant(u, du, v, dv, w, dw);
  TimeOfImpact impact;
  const Roots roots = crossings(f);
  for (int i = 0; i < roots.count; ++i) {
    const double t = roots.t[static_cast<std::size_t>(i)];
    // The determinant decreases if p passes from front to back.
    const double slope = f.c[1] + t * (2.0 * f.c[2] + 3.0 * f.c[3] * t);
    if (slope > 0.0) continue;
    const Vec3 vt = v + t * dv, wt = w + t * dw, ut = u + t * du;
    const Vec3 n = vt.cross(wt);
    const double n2 = n.squaredNorm();
    if (!(n2 > 0.0)) continue;
    const double wb = ut.cross(wt).dot(n) / n2;
    const double wc = vt.cross(ut).dot(n) / n2;
    constexpr double slack = -1e-6;  // no gap between triangles that share an edge
    if (!(wb >= slack && wc >= slack && 1.0 - wb - wc >= slack)) continue;
    impact.found = true;
    impact.time = t;
    impact.weight = {1.0 - wb - wc, wb, wc};
    impact.normal = n / std::sqrt(n2);
    return impact;
  }
  return impact;
}

// The first time at which edge a b passes through edge c d. The normal points to the side that a b
// came from; weight[0] is s on a b, weight[1] is t on c d.
inline TimeOfImpact impact_of_edges(const NodeAndTriangle& m) {
  const Vec3 &a0 = m.p0, &b0 = m.a0, &c0 = m.b0, &d0 = m.c0;
  const Vec3 &a1 = m.p1, &b1 = m.a1, &c1 = m.b1, &d1 = m.c1;
  const Vec3 r = a0 - c0, dr = a1 - c1 - r;
  const Vec3 u = b0 - a0, du = b1 - a1 - u;
  const Vec3 v = d0 - c0, dv = d1 - c1 - v;
  const Cubic f = moving_determinant(r, dr, u, du, v, dv);
  TimeOfImpact impact;
  const Roots roots = crossings(f);
  for (int i = 0; i < roots.count; ++i) {
    const double t = roots.t[static_cast<std::size_t>(i)];
    const Vec3 ut = u + t * du, vt = v + t * dv, rt = r + t * dr;
    const double uu = ut.squaredNorm(), vv = vt.squaredNorm(), uv = ut.dot(vt);
    const double area2 = uu * vv - uv * uv;
    if (!(area2 > 1e-6 * uu * vv)) continue;
    const double on_u = (uv * vt.dot(rt) - vv * ut.dot(rt)) / area2;
    const double on_v = (uu * vt.dot(rt) - uv * ut.dot(rt)) / area2;
    constexpr double slack = -1e-6;
    if (!(on_u >= slack && on_u <= 1.0 - slack && on_v >= slack && on_v <= 1.0 - slack)) continue;
    Vec3 n = ut.cross(vt).normalized();
    const double slope = f.c[1] + t * (2.0 * f.c[2] + 3.0 * f.c[3] * t);
    impact.found = true;
    impact.time = t;
    impact.weight = {on_u, on_v, 0.0};
    // det = r . (u x v). If it falls to zero, r is on the side of n.
    impact.normal = slope > 0.0 ? Vec3(-n) : n;
    return impact;
  }
  return impact;
}

}  // namespace sinew
