#include "sinew/contact/rods.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sinew/contact/closest.h"

namespace sinew {
namespace {

// Triangle and rod at a share s of the step.
struct Sweep {
  Corners x0, x1;
  const MovingRod& rod;

  Corners corners(double s) const {
    Corners c;
    for (std::size_t i = 0; i < 3; ++i) c[i] = x0[i] + s * (x1[i] - x0[i]);
    return c;
  }
  NearestPair nearest(double s) const {
    return nearest_of_segment_and_triangle(rod.a0 + s * (rod.a1 - rod.a0),
                                           rod.b0 + s * (rod.b1 - rod.b0), corners(s));
  }
  // An upper bound of the decrease of the distance in the step.
  double approach_bound() const {
    const Vec3 mean = 0.5 * (rod.a1 - rod.a0 + rod.b1 - rod.b0);
    double of_triangle = 0.0;
    for (std::size_t i = 0; i < 3; ++i)
      of_triangle = std::max(of_triangle, (x1[i] - x0[i] - mean).norm());
    return of_triangle + (rod.a1 - rod.a0 - mean).norm();
  }
  // The share of the step after which the distance first equals the radius, by conservative
  // advancement (Mirtich 1996): it never steps past the hit.
  std::optional<double> time_of_impact(double approach) const {
    double s = 0.0;
    for (int i = 0; i < 200; ++i) {
      const double space = nearest(s).distance - rod.radius;
      if (space <= 1e-6 * rod.radius) return s;
      s += space / approach;
      if (s > 1.0) return {};
    }
    return s;
  }
};

// The normal of a pair: a unit vector from the rod to the triangle. If the rod's axis is in the
// surface itself, it points into the body.
Vec3 pair_normal(const NearestPair& p, const Vec3& outward) {
  return p.distance > 0.0 ? Vec3((p.on_triangle - p.on_segment) / p.distance) : Vec3(-outward);
}

Vec3 outward_of(const Corners& c) {
  const Vec3 n = (c[1] - c[0]).cross(c[2] - c[0]);
  const double length = n.norm();
  return length > 0.0 ? Vec3(n / length) : Vec3(Vec3::Zero());
}

struct Hit {
  NearestPair pair;
  Vec3 normal = Vec3::UnitY();
  double facing = 0.0;   // -normal . outward normal of the triangle, in [-1, 1]
  bool crossed = false;  // hit during the step: the pair is the one at the time of impact
};

std::optional<Hit> hit_of(const Sweep& sweep, double reach) {
  const double radius = sweep.rod.radius;
  const NearestPair last = sweep.nearest(1.0);
  const double approach = sweep.approach_bound();
  if (last.distance - radius >= reach && last.distance - radius > approach) return {};
  const NearestPair first = sweep.nearest(0.0);
  const Vec3 out0 = outward_of(sweep.x0);
  const Vec3 out1 = outward_of(sweep.x1);
  const Vec3 n0 = pair_normal(first, out0);
  const Vec3 n1 = pair_normal(last, out1);
  const bool may_cross = approach >= first.distance;
  const bool same_side = last.distance > 0.0 && n0.dot(n1) > 0.0;
  if (!may_cross || same_side) {
    if (last.distance - radius >= reach) return {};
    return Hit{last, n1, -n1.dot(out1), false};
  }
  const auto toi = sweep.time_of_impact(approach);
  if (!toi) {
    if (last.distance - radius >= reach) return {};
    return Hit{last, n1, -n1.dot(out1), false};
  }
  const NearestPair pair = sweep.nearest(*toi);
  const Vec3 out = outward_of(sweep.corners(*toi));
  const Vec3 n = pair_normal(pair, out);
  return Hit{pair, n, -n.dot(out), true};
}

Contact contact_of(const Hit& hit, const MovingRod& rod, const Triangle& t,
                   const std::vector<Vec3>& to) {
  Contact c;
  for (int i = 0; i < 3; ++i) {
    if (hit.pair.weight[i] == 0.0) continue;
    c.node[static_cast<std::size_t>(c.count)] = t[static_cast<std::size_t>(i)];
    c.weight[static_cast<std::size_t>(c.count)] = hit.pair.weight[i];
    ++c.count;
  }
  c.normal = hit.normal;
  c.anchor = rod.a1 + hit.pair.share * (rod.b1 - rod.a1) + rod.radius * hit.normal;
  c.gap = contact_gap(c, to);
  return c;
}

// The hit of an edge, as found for one of its triangles.
struct EdgeHit {
  Index edge = -1;
  Index triangle = -1;
  Contact contact;
  double facing = 0.0;
  bool crossed = false;
};

}  // namespace

MovingRod moving_rod(const shapes::Rod& rod, const Pose& before, const Pose& after) {
  return {before.at(rod.a), before.at(rod.b), after.at(rod.a),
          after.at(rod.b),  rod.radius,       rod.a == rod.b};
}

void add_rod_contacts(const MovingRod& rod, const Skin& skin, const std::vector<Index>& near,
                      const std::vector<Vec3>& from, const std::vector<Vec3>& to, double reach,
                      std::vector<Contact>& out) {
  Eigen::AlignedBox3d box;
  for (const Vec3* end : {&rod.a0, &rod.b0, &rod.a1, &rod.b1}) box.extend(*end);
  const Vec3 margin = Vec3::Constant(rod.radius + reach);
  box = Eigen::AlignedBox3d(Vec3(box.min() - margin), Vec3(box.max() + margin));

  std::vector<EdgeHit> edges;
  for (const Index index : near) {
    const Triangle& t = skin.triangles[uz(index)];
    Sweep sweep{{}, {}, rod};
    Eigen::AlignedBox3d around;
    for (std::size_t i = 0; i < 3; ++i) {
      sweep.x0[i] = from[uz(t[i])];
      sweep.x1[i] = to[uz(t[i])];
      around.extend(sweep.x0[i]);
      around.extend(sweep.x1[i]);
    }
    if (!around.intersects(box)) continue;
    const auto hit = hit_of(sweep, reach);
    if (!hit) continue;
    if (!rod.ball && (hit->pair.share <= 0.0 || hit->pair.share >= 1.0)) continue;
    Contact c = contact_of(*hit, rod, t, to);
    if (c.count == 3 && hit->facing > 0.0) {
      c.id.kind = ContactKind::triangle_rod;
      c.id.feature = index;
      out.push_back(c);
    } else if (c.count == 2) {
      const Vec3& weight = hit->pair.weight;
      const std::size_t apex = weight[0] == 0.0 ? 0 : weight[1] == 0.0 ? 1 : 2;
      c.id.kind = ContactKind::edge_rod;
      c.id.feature = skin.triangle_edges[uz(index)][apex];
      edges.push_back({c.id.feature, index, c, hit->facing, hit->crossed});
    }
  }
  // An edge counts once, if the rod is on the outside of its triangles (sum of `facing` > 0). The
  // edge need not be nearest for both triangles: in a step with deep penetration the two may
  // differ, and the contact would be missed.
  std::sort(edges.begin(), edges.end(), [](const EdgeHit& a, const EdgeHit& b) {
    return std::pair(a.edge, a.triangle) < std::pair(b.edge, b.triangle);
  });
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i;
    double facing = 0.0;
    const EdgeHit* chosen = &edges[i];
    for (; end < edges.size() && edges[end].edge == edges[i].edge; ++end) {
      facing += edges[end].facing;
      if (edges[end].crossed && !chosen->crossed) chosen = &edges[end];
    }
    if (facing > 0.0) out.push_back(chosen->contact);
    i = end;
  }
}

}  // namespace sinew
