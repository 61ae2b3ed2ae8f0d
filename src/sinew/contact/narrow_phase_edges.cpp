// Edges against edges: the edge part of NarrowPhase.
#include <algorithm>
#include <cmath>

#include "sinew/contact/narrow_phase.h"
#include "sinew/contact/nearest.h"
#include "sinew/contact/time_of_impact.h"

namespace sinew {
namespace {

// An edge may be deeper than its nearest end is away by this share of the size.
constexpr double end_share = 0.05;

}  // namespace

double NarrowPhase::edge_size(Index edge) const {
  double size = std::numeric_limits<double>::infinity();
  for (const Index t : surface_.edge_triangles[uz(edge)]) {
    if (t >= 0) size = std::min(size, surface_.triangle_size[uz(t)]);
  }
  return size;
}

double NarrowPhase::edge_range(Index edge, Index owner, double reach) const {
  return std::max(reach, depth_share * std::min(edge_size(edge), largest_size_[uz(owner)]));
}

double NarrowPhase::rest_distance(const Edge& a, const Edge& b) const {
  return segments_distance(rest_[uz(a[0])], rest_[uz(a[1])], rest_[uz(b[0])], rest_[uz(b[1])]);
}

bool NarrowPhase::edges_too_far(Index a, Index b, double distance) const {
  return distance >= self_share * rest_distance(surface_.edges[uz(a)], surface_.edges[uz(b)]);
}

// Whether the surface around an edge is behind the plane through the edge with normal n, at a time
// of the step: then the edge can be touched with the normal n. `slack`: the sine of the angle by
// which the surface may rise above the plane.
bool NarrowPhase::supports(Index edge, const Vec3& n, const Moves& m, double time,
                           double slack) const {
  const Edge& e = surface_.edges[uz(edge)];
  const auto at = [&](Index i) { return between(m.from[uz(i)], m.to[uz(i)], time); };
  const Vec3 a = at(e[0]);
  const Vec3 along = unit(at(e[1]) - a);
  Vec3 out = Vec3::Zero();
  for (const Index t : surface_.edge_triangles[uz(edge)]) {
    if (t < 0) return false;
    const Triangle& tri = surface_.triangles[uz(t)];
    for (const Index i : tri) {
      if (i == e[0] || i == e[1]) continue;
      const Vec3 r = at(i) - a;
      const double height = (r - along.dot(r) * along).norm();
      if (!(n.dot(r) <= slack * height)) return false;
    }
    const Vec3 p = at(tri[0]);
    out += unit((at(tri[1]) - p).cross(at(tri[2]) - p));
  }
  return n.dot(out) > 0.0;
}

bool NarrowPhase::edge_contact(Index ea, Index eb, bool skip_ccd, const Moves& moves,
                               Contact& c) const {
  const Edge &a = surface_.edges[uz(ea)], &b = surface_.edges[uz(eb)];
  const auto& x = moves.to;
  const OnLines on = nearest_on_lines(x[uz(a[0])], x[uz(a[1])], x[uz(b[0])], x[uz(b[1])]);
  const bool over = !on.parallel && on.s > 0.0 && on.s < 1.0 && on.t > 0.0 && on.t < 1.0;
  if (skip_ccd && !over) return false;
  const double size = std::min(edge_size(ea), edge_size(eb));
  const Index owner = triangle_owner_[uz(surface_.edge_triangles[uz(eb)][0])];
  const bool self = triangle_owner_[uz(surface_.edge_triangles[uz(ea)][0])] == owner;
  if (self && adjoin(a, b)) return false;
  c = Contact{};
  c.count = 4;
  c.friction = friction_;
  c.restitution = restitution_;
  c.node = {a[0], a[1], b[0], b[1]};
  c.id = {ContactKind::edge_edge, owner, ea, eb};
  const auto set = [&](double s, double t, const Vec3& n) {
    c.weight = {1.0 - s, s, t - 1.0, -t};
    c.normal = n;
    c.gap = contact_gap(c, moves.to);
  };

  // At the end of the step.
  if (over) {
    Vec3 n = unit((x[uz(a[1])] - x[uz(a[0])]).cross(x[uz(b[1])] - x[uz(b[0])]));
    // If the penetration is larger than the distance to the nearest end of either edge, other
    // features touch there.
    const double to_end = std::min(std::min(on.s, 1.0 - on.s) * (x[uz(a[1])] - x[uz(a[0])]).norm(),
                                   std::min(on.t, 1.0 - on.t) * (x[uz(b[1])] - x[uz(b[0])]).norm());
    for (int turn = 0; turn < 2; ++turn, n = -n) {
      if (!supports(eb, n, moves, 1.0, 0.1) || !supports(ea, -n, moves, 1.0, 0.1)) continue;
      set(on.s, on.t, n);
      if (!(c.gap < moves.reach || (c.gap <= 0.0 && moves.reach == 0.0))) continue;
      if (c.gap < -depth_share * size) continue;
      if (c.gap < -to_end - end_share * size) continue;
      if (self && !(std::abs(c.gap) < self_share * rest_distance(a, b))) continue;
      const double before = contact_gap(c, moves.from);
      c.time_of_impact = before <= 0.0 ? 0.0 : (c.gap < 0.0 ? before / (before - c.gap) : 1.0);
      return true;
    }
  }

  // CCD during the step.
  if (skip_ccd) return false;
  const auto move = [&](Index i) -> Vec3 { return moves.to[uz(i)] - moves.from[uz(i)]; };
  double motion = 0.0;
  for (const Index i : a) {
    for (const Index j : b) motion = std::max(motion, (move(i) - move(j)).squaredNorm());
  }
  if (!(motion > ccd_share * ccd_share * size * size)) return false;
  const TimeOfImpact hit = impact_of_edges(motion_of(a[0], a[1], b[0], b[1], moves.from, moves.to));
  if (!hit.found || (self && rest_distance(a, b) == 0.0)) return false;
  if (!supports(eb, hit.normal, moves, hit.time, 0.25)) return false;
  if (!supports(ea, -hit.normal, moves, hit.time, 0.25)) return false;
  set(hit.weight[0], hit.weight[1], hit.normal);
  c.time_of_impact = hit.time;
  return c.gap < moves.reach || (c.gap <= 0.0 && moves.reach == 0.0);
}

}  // namespace sinew
