#include "sinew/contact/narrow_phase.h"

#include <algorithm>
#include <cmath>

#include "sinew/contact/time_of_impact.h"

namespace sinew {
namespace {

constexpr double max_cosine = 0.3;       // largest cosine between the normals of node and triangle
constexpr double max_cosine_self = 0.0;  // the same within a body
constexpr double rim_share = 1e-3;       // of the local size, that a node on a rim may be outside

// The nearest point of a triangle.
OnTriangle nearest_on(const Vec3& p, const std::vector<Vec3>& x, const Triangle& t) {
  return nearest_on_triangle(p, x[uz(t[0])], x[uz(t[1])], x[uz(t[2])]);
}

// The largest motion of the triangle's corners relative to the node in the step.
double relative_motion(Index p, const Triangle& t, const Moves& m) {
  const Vec3 dp = m.to[uz(p)] - m.from[uz(p)];
  double most = 0.0;
  for (const Index i : t) {
    most = std::max(most, (m.to[uz(i)] - m.from[uz(i)] - dp).squaredNorm());
  }
  return std::sqrt(most);
}

}  // namespace

NarrowPhase::NarrowPhase(const Model& model)
    : surface_(model.surface), rest_(model.rest_position), rim_(model.rest_position.size(), 0) {
  if (model.body_contact) {
    friction_ = model.body_contact->friction;
    restitution_ = model.body_contact->restitution;
  }
  triangle_owner_.resize(surface_.triangles.size());
  open_.resize(surface_.triangles.size());
  for (Index o = 0; o < surface_.owner_count(); ++o) {
    double largest = 0.0;
    double smallest = std::numeric_limits<double>::infinity();
    const Range r = surface_.owner_triangles[uz(o)];
    for (Index t = r.begin; t < r.end; ++t) {
      triangle_owner_[uz(t)] = o;
      largest = std::max(largest, surface_.triangle_size[uz(t)]);
      smallest = std::min(smallest, surface_.triangle_size[uz(t)]);
    }
    largest_size_.push_back(largest);
    smallest_size_.push_back(smallest);
  }
  for (const Triangle& t : surface_.triangles) rest_plane_.push_back(plane_of(rest_, t));
  slot_of_.assign(rest_.size(), -1);
  neighbour_start_.push_back(0);
  for (std::size_t i = 0; i < surface_.nodes.size(); ++i) {
    slot_of_[uz(surface_.nodes[i])] = static_cast<Index>(i);
    Vec3 sum = Vec3::Zero();
    std::vector<Index> around;
    for (Index k = surface_.ring_start[i]; k < surface_.ring_start[i + 1]; ++k) {
      const Index t = surface_.ring[uz(k)];
      const Plane& plane = rest_plane_[uz(t)];
      sum += plane.length * plane.normal;
      around.insert(around.end(), surface_.triangles[uz(t)].begin(),
                    surface_.triangles[uz(t)].end());
    }
    rest_normal_.push_back(unit(sum));
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    neighbour_.insert(neighbour_.end(), around.begin(), around.end());
    neighbour_start_.push_back(static_cast<Index>(neighbour_.size()));
  }
  for (std::size_t e = 0; e < surface_.edges.size(); ++e) {
    if (surface_.edge_triangles[e][1] != -1) continue;
    const Index t = surface_.edge_triangles[e][0];
    for (std::size_t c = 0; c < 3; ++c) {
      const Index i = surface_.triangles[uz(t)][c];
      if (i != surface_.edges[e][0] && i != surface_.edges[e][1]) open_[uz(t)][c] = 1;
    }
    for (const Index i : surface_.edges[e]) rim_[uz(i)] = 1;
  }
}

double NarrowPhase::node_range(Index slot, Index owner, double reach) const {
  return std::max(reach,
                  depth_share * std::min(surface_.node_size[uz(slot)], largest_size_[uz(owner)]));
}

double NarrowPhase::rest_distance(Index node, const Triangle& t) const {
  return std::sqrt(nearest_on(rest_[uz(node)], rest_, t).distance2);
}

bool NarrowPhase::on_boundary(Index t, const OnTriangle& on) const {
  const Triangle& tri = surface_.triangles[uz(t)];
  for (std::size_t c = 0; c < 3; ++c) {
    if (on.weight[c] == 1.0) return rim_[uz(tri[c])] != 0;
  }
  for (std::size_t c = 0; c < 3; ++c) {
    if (on.weight[c] == 0.0) return open_[uz(t)][c] != 0;
  }
  return false;
}

bool NarrowPhase::adjoin(Index slot, const Triangle& t) const {
  const auto near = neighbours(slot);
  return std::any_of(t.begin(), t.end(),
                     [&](Index i) { return std::find(near.begin(), near.end(), i) != near.end(); });
}

bool NarrowPhase::adjoin(const Edge& a, const Edge& b) const {
  return std::any_of(a.begin(), a.end(), [&](Index i) {
    const auto near = neighbours(slot_of(i));
    return std::find(near.begin(), near.end(), b[0]) != near.end() ||
           std::find(near.begin(), near.end(), b[1]) != near.end();
  });
}

// Whether node and triangle are on two sides of a slit: at rest they face each other across a gap,
// not through material.
bool NarrowPhase::slit(Index slot, Index t, double at_rest) const {
  const Vec3& n = rest_plane_[uz(t)].normal;
  if (!(rest_normal_[uz(slot)].dot(n) < -0.5)) return false;
  const Vec3& a = rest_[uz(surface_.triangles[uz(t)][0])];
  const double rounding = 1e-9 * surface_.triangle_size[uz(t)];  // the lips of a cut have no gap
  return n.dot(rest_[uz(surface_.nodes[uz(slot)])] - a) > 0.5 * at_rest - rounding;
}

bool NarrowPhase::node_too_far(Index slot, Index t, double distance) const {
  const double at_rest = rest_distance(surface_.nodes[uz(slot)], surface_.triangles[uz(t)]);
  return distance >= self_share * at_rest && !slit(slot, t, at_rest);
}

double NarrowPhase::ccd_motion(Index a, Index b) const {
  return ccd_share * std::min(smallest_size_[uz(a)], smallest_size_[uz(b)]);
}

// Whether a node and a triangle of one body that are near each other have come together from
// elsewhere. Neighbours and opposite sides of the same piece of material do not count.
bool NarrowPhase::self_pair_counts(Index slot, Index t, const OnTriangle& on, double side,
                                   const std::vector<Vec3>& from) const {
  const Index node = surface_.nodes[uz(slot)];
  const Triangle& tri = surface_.triangles[uz(t)];
  if (adjoin(slot, tri)) return false;
  const double at_rest = rest_distance(node, tri);
  if (!(std::sqrt(on.distance2) < self_share * at_rest))
    return side < 0.0 && slit(slot, t, at_rest);
  if (side >= 0.0) return true;
  // At rest the node is behind the triangle, with material in between: it counts only if it comes
  // from the front.
  const Vec3& n = rest_plane_[uz(t)].normal;
  const double behind = n.dot(rest_[uz(node)] - rest_[uz(tri[0])]);
  if (!(behind < 0.0 && rest_normal_[uz(slot)].dot(n) < 0.0)) return true;
  return plane_of(from, tri).normal.dot(from[uz(node)] - from[uz(tri[0])]) >
         -0.2 * self_share * at_rest;
}

// Keeps the nearer of two triangles. If the nearest point is common to both (an edge or a corner),
// it keeps the triangle whose plane is farther from the node: the side of that plane is the node's
// side of the surface. The side of the other plane may be wrong (Baerentzen and Aanaes 2005 use a
// mean of the planes for this).
void NarrowPhase::Near::keep_nearer(const Near& other) {
  constexpr double same = 1e-7;
  if (triangle >= 0) {
    if (other.on.distance2 > on.distance2 * (1.0 + same) + 1e-30) return;
    if (other.on.distance2 >= on.distance2 * (1.0 - same) - 1e-30) {
      const double mine = std::abs(side), its = std::abs(other.side);
      if (its < mine * (1.0 - 1e-9)) return;
      if (its <= mine * (1.0 + 1e-9) && other.triangle > triangle) return;
    }
  }
  *this = other;
}

template <typename PlaneOf>
NarrowPhase::Nearest NarrowPhase::nearest(Index slot, bool self, const NearTriangles& triangles,
                                          const PlaneOf& plane_at, const std::vector<Vec3>& x,
                                          const std::vector<Vec3>& from, double range) const {
  const Index node = surface_.nodes[uz(slot)];
  const Vec3& p = x[uz(node)];
  Vec3 normal = Vec3::Zero();
  double length = 0.0;
  bool known = false;
  Nearest result;
  const auto consider = [&](Index t, const Plane& plane, const OnTriangle& on) {
    Near near;
    near.triangle = t;
    near.on = on;
    near.plane = plane.normal;
    near.side = plane.normal.dot(p - on.point);
    near.inside = near.side < 0.0 && !on_boundary(t, on);
    if (self && !self_pair_counts(slot, t, on, near.side, from)) return;
    if (!known) {
      for (Index k = surface_.ring_start[uz(slot)]; k < surface_.ring_start[uz(slot) + 1]; ++k) {
        const Plane& around = plane_at(surface_.ring[uz(k)]);
        normal += around.length * around.normal;
      }
      length = normal.norm();
      known = true;
    }
    if (!self) result.any.keep_nearer(near);
    if (normal.dot(near.plane) < (self ? max_cosine_self : max_cosine) * length)
      result.fit.keep_nearer(near);
  };
  const std::size_t count = triangles.triangle.size();
  for (std::size_t k = 0; k < count; ++k) {
    // Triangles beyond this distance cannot change the result.
    const double useful2 =
        result.fit.triangle < 0
            ? range * range
            : (self ? result.fit.on.distance2
                    : std::max(result.fit.on.distance2, result.any.on.distance2)) *
                      (1.0 + 1e-6) +
                  1e-29;
    if (!triangles.far.empty()) {
      const double least = static_cast<double>(triangles.far[k]) - triangles.moved;
      if (least > 0.0 && least * least > useful2) break;
    }
    const Index t = triangles.triangle[k];
    const Triangle& tri = surface_.triangles[uz(t)];
    const Plane& plane = plane_at(t);
    const Vec3 &a = x[uz(tri[0])], &b = x[uz(tri[1])], &c = x[uz(tri[2])];
    const Vec3 ab = b - a, ac = c - a, ap = p - a;
    const double side = plane.normal.dot(ap);
    const double side2 = side * side;
    if (side2 > range * range) continue;
    // The normal of a needle-shaped triangle is noise.
    if (plane.length > 1e-10 * std::max(ab.squaredNorm(), ac.squaredNorm())) {
      const double b_area = ap.cross(ac).dot(plane.normal);
      const double c_area = ab.cross(ap).dot(plane.normal);
      const double a_area = plane.length - b_area - c_area;
      if (a_area > 0.0 && b_area > 0.0 && c_area > 0.0) {
        OnTriangle on;
        const double wb = b_area / plane.length, wc = c_area / plane.length;
        on.weight = {1.0 - wb - wc, wb, wc};
        on.point = a + wb * ab + wc * ac;
        on.distance2 = side2;
        consider(t, plane, on);
        continue;
      }
      // Lower bound: the distance from the plane and from the line of an edge that the node is
      // beyond.
      const auto beyond = [&](double area, const Vec3& edge) {
        return area < 0.0 &&
               (side2 - useful2) * edge.squaredNorm() + area * area * (1.0 - 1e-9) > 0;
      };
      if (beyond(a_area, c - b) || beyond(b_area, ac) || beyond(c_area, ab)) continue;
    }
    const OnTriangle on = nearest_on(p, x, tri);
    if (on.distance2 <= range * range) consider(t, plane, on);
  }
  if (self) result.any = result.fit;
  return result;
}

// Fills the contact with a triangle that is near at the end of the step.
bool NarrowPhase::node_contact_of(Index slot, const Near& near, double range, const Moves& moves,
                                  Contact& c) const {
  const Triangle& tri = surface_.triangles[uz(near.triangle)];
  const Vec3 r = moves.to[uz(surface_.nodes[uz(slot)])] - near.on.point;
  const double distance = near.distance();
  const bool face = near.on.weight[0] > 0.0 && near.on.weight[1] > 0.0 && near.on.weight[2] > 0.0;
  c.normal = near.plane;
  if (!face && !near.inside && distance > 1e-6 * range) c.normal = r / distance;
  if (!face && near.inside && distance > 1e-6 * range) c.normal = -r / distance;
  if (!(c.normal.squaredNorm() > 0.5)) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    c.node[k + 1] = tri[k];
    c.weight[k + 1] = -near.on.weight[k];
  }
  return true;
}

NodeProximity NarrowPhase::node_contact(Index slot, Index owner, const NearTriangles& triangles,
                                        std::span<const Plane> planes, bool skip_ccd,
                                        const Moves& moves, Contact& c) const {
  const Index node = surface_.nodes[uz(slot)];
  const bool self = surface_.owner_nodes[uz(owner)].contains(slot);
  const double range = node_range(slot, owner, moves.reach);
  const auto at_end = [&](Index t) -> const Plane& { return planes[uz(t)]; };
  const Nearest end = nearest(slot, self, triangles, at_end, moves.to, moves.from, range);
  const NodeProximity other = end.any.triangle < 0 ? NodeProximity::none : NodeProximity::near;
  if (skip_ccd && end.fit.triangle < 0) return other;

  c.count = 4;
  c.friction = friction_;
  c.restitution = restitution_;
  c.node[0] = node;
  c.weight[0] = 1.0;

  // CCD during the step.
  TimeOfImpact hit;
  Index hit_triangle = -1;
  const auto fast = [&](Index t) {
    return relative_motion(node, surface_.triangles[uz(t)], moves) >
           ccd_share * std::min(surface_.node_size[uz(slot)], surface_.triangle_size[uz(t)]);
  };
  if (!skip_ccd) {
    const auto at_start = [&](Index t) { return plane_of(moves.from, surface_.triangles[uz(t)]); };
    const Nearest start = nearest(slot, self, triangles, at_start, moves.from, moves.from, range);
    if (start.any.inside && start.fit.inside && fast(start.fit.triangle) &&
        start.fit.distance() <= pair_depth(slot, start.fit.triangle)) {
      hit = {true, 0.0, start.fit.on.weight, start.fit.plane};
      hit_triangle = start.fit.triangle;
    } else {
      for (const Index t : triangles.triangle) {
        const Triangle& tri = surface_.triangles[uz(t)];
        if (!fast(t)) continue;
        if (self && (adjoin(slot, tri) || rest_distance(node, tri) == 0.0)) continue;
        const TimeOfImpact m =
            impact_of_node(motion_of(node, tri[0], tri[1], tri[2], moves.from, moves.to));
        if (!m.found ||
            (hit.found && (hit.time < m.time || (hit.time == m.time && hit_triangle < t)))) {
          continue;
        }
        hit = m;
        hit_triangle = t;
      }
    }
  }

  // At the end of the step.
  // A node on the rim of a flush body lies on the side of the other: rounding decides on which side
  // of that plane. It counts as inside.
  const bool inside =
      end.any.inside ||
      (end.any.triangle >= 0 && end.any.distance() <= rim_share * surface_.node_size[uz(slot)]);
  const bool deep =
      inside && end.fit.inside && end.fit.distance() <= pair_depth(slot, end.fit.triangle);
  const bool close = !end.any.inside && end.fit.triangle >= 0 && !end.fit.inside &&
                     end.fit.distance() < moves.reach;
  const auto finish = [&](Index t) {
    c.gap = contact_gap(c, moves.to);
    c.id = {ContactKind::node_triangle, owner, slot, t};
    return c.gap < moves.reach || (c.gap <= 0.0 && moves.reach == 0.0);
  };
  if (hit.found && !(deep && hit.normal.dot(end.fit.plane) > 0.5)) {
    const Triangle& tri = surface_.triangles[uz(hit_triangle)];
    for (std::size_t k = 0; k < 3; ++k) {
      c.node[k + 1] = tri[k];
      c.weight[k + 1] = -hit.weight[k];
    }
    c.normal = hit.normal;
    c.time_of_impact = hit.time;
    if (finish(hit_triangle)) return NodeProximity::contact;
  }
  if (!(deep || close)) return other;
  if (!node_contact_of(slot, end.fit, range, moves, c)) return other;
  if (hit.found) {
    c.time_of_impact = hit.time;
  } else {  // the gap is taken to change linearly
    const double before = contact_gap(c, moves.from);
    const double after = contact_gap(c, moves.to);
    c.time_of_impact = before <= 0.0 ? 0.0 : (after < 0.0 ? before / (before - after) : 1.0);
  }
  return finish(end.fit.triangle) ? NodeProximity::contact : other;
}

}  // namespace sinew
