#include "sinew/contact/colliders.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include "sinew/base/parallel.h"
#include "sinew/contact/rods.h"
#include "sinew/mesh/surface.h"

namespace sinew {
namespace {

// A hard obstacle with a shape, during a step.
template <SolidShape S>
struct Moving {
  const Obstacle* obstacle = nullptr;
  const S* shape = nullptr;
  Index index = -1;
  Pose before, after;
  Eigen::AlignedBox3d box;  // around its whole motion, with the reach; infinite for a plane
};

template <SolidShape S>
Moving<S> moving(const Model& model, const Controls& controls, const S& shape, Index index,
                 double t0, double t1, double reach) {
  Moving<S> m{&model.obstacles[uz(index)],
              &shape,
              index,
              obstacle_pose(model, controls, index, t0),
              obstacle_pose(model, controls, index, t1),
              {}};
  const bool turns = !m.before.turn.isApprox(m.after.turn, 0.0);
  for (const Pose* pose : {&m.before, &m.after}) {
    // During a rotation the shape can reach beyond both end poses. The box of its bounding ball
    // covers all of them.
    const Vec3 half = turns ? Vec3::Constant(shape.farthest()) : shape.extent(pose->turn);
    m.box.extend(pose->center - half - Vec3::Constant(reach));
    m.box.extend(pose->center + half + Vec3::Constant(reach));
  }
  return m;
}

// ---- nodes ----

// The point of the surface that a node moving from q0 to q1 (in the shape's frame) must stay
// outside of, or none: the nearest point at q1 if it is on the side that the node came from, else
// the point of entry.
template <SolidShape S>
std::optional<shapes::SurfacePoint> wall_for(const S& shape, const Vec3& q0, const Vec3& q1,
                                             double reach) {
  const shapes::SurfacePoint last = shape.surface(q1);
  const bool within = last.distance < reach;
  if (!within && last.distance > (q1 - q0).norm()) return {};

  const shapes::SurfacePoint first = shape.surface(q0);
  const bool through = last.distance >= 0.0;  // a node that was inside has left the shape again
  std::optional<shapes::SurfacePoint> side;
  if (first.distance <= 0.0) {
    if (!through || first.normal.dot(last.normal) < 0.0) side = first;
  } else if (const auto s = shape.enters(q0, q1)) {
    side = shape.surface(q0 + *s * (q1 - q0));
  }
  if (!side) return within ? std::optional(last) : std::nullopt;
  const bool agree = side->normal.dot(last.normal) > 0.5 ||
                     (!through && last.normal.dot(q0 - last.nearest) >= 0.0);
  return within && agree ? last : *side;
}

// The share of the step after which the gap becomes 0, from the gaps at its start and end.
double impact_time(double before, double after) {
  if (after >= 0.0) return 1.0;
  return before <= 0.0 ? 0.0 : before / (before - after);
}

template <SolidShape S>
void add_node(const Moving<S>& m, Index node, const std::vector<Vec3>& from,
              const std::vector<Vec3>& to, double reach, std::vector<Contact>& out) {
  const Vec3 q0 = m.before.own(from[uz(node)]);
  const Vec3 q1 = m.after.own(to[uz(node)]);
  const auto wall = wall_for(*m.shape, q0, q1, reach);
  if (!wall) return;
  Contact c;
  c.node[0] = node;
  c.weight[0] = 1.0;
  c.count = 1;
  c.normal = m.after.turn * wall->normal;
  c.anchor = m.after.at(wall->anchor);
  c.anchor_displacement = m.after.at(wall->nearest) - m.before.at(wall->nearest);
  c.gap = contact_gap(c, to);
  c.time_of_impact = impact_time(wall->normal.dot(q0 - wall->nearest), c.gap);
  c.friction = m.obstacle->friction;
  c.restitution = m.obstacle->restitution;
  c.id = {ContactKind::node_shape, m.index, node, -1};
  out.push_back(c);
}

// ---- triangles ----

// The sides of a box that a node is beyond at both ends of its motion, as bits. If three nodes
// share a bit, their triangle is beyond that side during the whole step.
unsigned beyond(const Eigen::AlignedBox3d& box, const Vec3& x0, const Vec3& x1) {
  unsigned bits = 0;
  for (int a = 0; a < 3; ++a) {
    bits |= (x0[a] < box.min()[a] && x1[a] < box.min()[a]) ? 1U << (2 * a) : 0U;
    bits |= (x0[a] > box.max()[a] && x1[a] > box.max()[a]) ? 2U << (2 * a) : 0U;
  }
  return bits;
}

// Whether every edge of the triangle is at most `longest` at rest [m].
bool is_small(const Model& model, const Triangle& t, double longest) {
  const auto& x = model.rest_position;
  const auto is_short = [&](std::size_t a, std::size_t b) {
    return (x[uz(t[a])] - x[uz(t[b])]).squaredNorm() <= longest * longest;
  };
  return is_short(0, 1) && is_short(1, 2) && is_short(2, 0);
}

// The box around the motion of a rod, with the reach.
Eigen::AlignedBox3d box_around(const MovingRod& rod, double reach) {
  Eigen::AlignedBox3d box;
  for (const Vec3* end : {&rod.a0, &rod.b0, &rod.a1, &rod.b1}) box.extend(*end);
  const Vec3 margin = Vec3::Constant(rod.radius + reach);
  return {box.min() - margin, box.max() + margin};
}

template <SolidShape S>
void add_triangles(const Model& model, const Moving<S>& m, std::size_t body,
                   const Eigen::AlignedBox3d& body_box, const std::vector<Vec3>& from,
                   const std::vector<Vec3>& to, double reach, std::vector<Contact>& out) {
  const std::vector<shapes::Rod> rods = m.shape->rods(model.skin.longest_edge[body]);
  if (rods.empty()) return;
  const double smooth = m.shape->smooth_to();
  const Range nodes = model.bodies[body].nodes;
  std::vector<unsigned char> outside(uz(nodes.size()));
  const Range own = model.skin.body_nodes[body];
  for (Index k = own.begin; k < own.end; ++k) {
    const auto n = uz(model.skin.nodes[uz(k)]);
    outside[n - uz(nodes.begin)] = static_cast<unsigned char>(beyond(m.box, from[n], to[n]));
  }
  std::vector<Index> near;
  const Range triangles = model.skin.body_triangles[body];
  for (Index t = triangles.begin; t < triangles.end; ++t) {
    unsigned shared = ~0U;
    double free = 0.0;
    for (const Index node : model.skin.triangles[uz(t)]) {
      shared &= outside[uz(node - nodes.begin)];
      free += model.inverse_mass[uz(node)];
    }
    if (shared != 0 || free == 0.0) continue;
    if (smooth > 0.0 && is_small(model, model.skin.triangles[uz(t)], smooth)) continue;
    near.push_back(t);
  }
  if (near.empty()) return;
  for (std::size_t r = 0; r < rods.size(); ++r) {
    const MovingRod rod = moving_rod(rods[r], m.before, m.after);
    if (!box_around(rod, reach).intersects(body_box)) continue;
    const std::size_t first = out.size();
    add_rod_contacts(rod, model.skin, near, from, to, reach, out);
    for (std::size_t i = first; i < out.size(); ++i) {
      Contact& c = out[i];
      const Vec3 place = m.after.own(c.anchor);
      c.anchor_displacement = c.anchor - m.before.at(place);
      double before = -c.normal.dot(c.anchor - c.anchor_displacement);
      for (int a = 0; a < c.count; ++a)
        before += c.weight[static_cast<std::size_t>(a)] *
                  c.normal.dot(from[uz(c.node[static_cast<std::size_t>(a)])]);
      c.time_of_impact = impact_time(before, c.gap);
      c.friction = m.obstacle->friction;
      c.restitution = m.obstacle->restitution;
      c.id.owner = m.index;
      c.id.partner = static_cast<Index>(r);
    }
  }
}

// The boxes around the motion of the bodies' surfaces.
std::vector<Eigen::AlignedBox3d> boxes_of_bodies(const Model& model, const std::vector<Vec3>& from,
                                                 const std::vector<Vec3>& to) {
  std::vector<Eigen::AlignedBox3d> boxes(model.bodies.size());
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    const Range own = model.skin.body_nodes[b];
    Eigen::AlignedBox3d& box = boxes[b];
    for (Index k = own.begin; k < own.end; ++k) {
      const auto n = uz(model.skin.nodes[uz(k)]);
      box.extend(from[n]);
      box.extend(to[n]);
    }
  }
  return boxes;
}

// Numbers the edges: the two triangles of an edge get the same number.
void number_edges(Skin& skin) {
  struct Side {
    Edge edge;
    std::size_t triangle, corner;
  };
  std::vector<Side> sides;
  for (std::size_t t = 0; t < skin.triangles.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      const auto [a, b] =
          std::minmax(skin.triangles[t][(c + 1) % 3], skin.triangles[t][(c + 2) % 3]);
      sides.push_back({{a, b}, t, c});
    }
  }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return a.edge < b.edge; });
  skin.triangle_edges.resize(skin.triangles.size());
  Index number = 0;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (i > 0 && sides[i].edge != sides[i - 1].edge) ++number;
    skin.triangle_edges[sides[i].triangle][sides[i].corner] = number;
  }
}

}  // namespace

void build_skin(Model& model) {
  Skin& skin = model.skin;
  if (!skin.nodes.empty()) return;
  skin.triangles = build_surface(model.tets, model.body_node_count()).triangles;
  std::vector<bool> on(uz(model.body_node_count()), false);
  for (const Triangle& t : skin.triangles)
    for (const Index node : t) on[uz(node)] = true;
  // A single mass, which belongs to no tet, is part of the surface.
  std::vector<bool> in_tet(on.size(), false);
  for (const Tet& tet : model.tets)
    for (const Index node : tet) in_tet[uz(node)] = true;
  for (std::size_t i = 0; i < on.size(); ++i) on[i] = on[i] || !in_tet[i];
  number_edges(skin);
  std::size_t t = 0;
  for (const Body& body : model.bodies) {
    Range triangles{static_cast<Index>(t), 0};
    double longest = 0.0;
    for (; t < skin.triangles.size() && body.nodes.contains(skin.triangles[t][0]); ++t) {
      const Triangle& f = skin.triangles[t];
      for (std::size_t e = 0; e < 3; ++e) {
        const Vec3& a = model.rest_position[uz(f[e])];
        const Vec3& b = model.rest_position[uz(f[(e + 1) % 3])];
        longest = std::max(longest, (b - a).norm());
      }
    }
    triangles.end = static_cast<Index>(t);
    Range nodes{static_cast<Index>(skin.nodes.size()), 0};
    for (Index i = body.nodes.begin; i < body.nodes.end; ++i)
      if (on[uz(i)]) skin.nodes.push_back(i);
    nodes.end = static_cast<Index>(skin.nodes.size());
    skin.body_nodes.push_back(nodes);
    skin.body_triangles.push_back(triangles);
    skin.longest_edge.push_back(longest);
  }
}

namespace {

// Contacts with a plane. Most nodes are in front of it and out of reach at both ends of the step:
// two dot products show that. The other nodes are treated like those of any shape, with the same
// result.
void add_nodes(const Model& model, const Moving<shapes::Plane>& plane,
               const std::vector<Vec3>& from, const std::vector<Vec3>& to, double reach,
               std::vector<Contact>& out) {
  for (const Index node : model.skin.nodes) {
    const auto n = uz(node);
    const double end = plane.after.own(to[n]).y();
    if (end >= reach && end > 0.0 && plane.before.own(from[n]).y() > 0.0) continue;
    if (model.inverse_mass[n] > 0.0) add_node(plane, node, from, to, reach, out);
  }
}

}  // namespace

void find_collider_contacts(const Model& model, const Controls& controls,
                            const std::vector<Vec3>& from, const std::vector<Vec3>& to, double t0,
                            double t1, const ContactReach& reach, std::vector<Contact>& out) {
  out.clear();
  std::vector<Eigen::AlignedBox3d> boxes;
  const auto find_with = [&]<SolidShape S>(const S& shape, Index index) {
    if (boxes.empty()) boxes = boxes_of_bodies(model, from, to);
    const auto m = moving(model, controls, shape, index, t0, t1, reach.near);
    for (std::size_t b = 0; b < boxes.size(); ++b) {
      if (!boxes[b].intersects(m.box)) continue;
      const Range own = model.skin.body_nodes[b];
      for (Index k = own.begin; k < own.end; ++k) {
        const Index node = model.skin.nodes[uz(k)];
        if (model.inverse_mass[uz(node)] == 0.0) continue;
        if (beyond(m.box, from[uz(node)], to[uz(node)]) != 0) continue;
        add_node(m, node, from, to, reach.near, out);
      }
      add_triangles(model, m, b, boxes[b], from, to, reach.near, out);
    }
  };
  const auto find_with_plane = [&](const shapes::Plane& shape, Index index) {
    add_nodes(model, moving(model, controls, shape, index, t0, t1, reach.plane), from, to,
              reach.plane, out);
  };
  for (std::size_t o = 0; o < model.obstacles.size(); ++o) {
    const Obstacle& obstacle = model.obstacles[o];
    if (!obstacle.hard()) continue;
    std::visit(
        Overloaded{
            [](const shapes::Mesh&) {},  // found by find_surfaces()
            [&](const shapes::Plane& shape) { find_with_plane(shape, static_cast<Index>(o)); },
            [&](const SolidShape auto& shape) { find_with(shape, static_cast<Index>(o)); }},
        obstacle.shape);
  }
  if (!std::is_sorted(out.begin(), out.end(), comes_before)) {
    std::sort(out.begin(), out.end(), comes_before);
  }
}

void name_rigid_contacts(const Model& model, const std::vector<Vec3>& from,
                         const std::vector<Vec3>& to, std::vector<Contact>& contacts) {
  const Index bodies = model.body_node_count();
  for (Contact& c : contacts) {
    int rigid = -1;
    for (int a = 0; a < c.count; ++a)
      if (c.node[static_cast<std::size_t>(a)] >= bodies) rigid = a;
    if (rigid < 0) continue;
    const Index vertex = c.node[static_cast<std::size_t>(rigid)];
    const auto found = std::find_if(
        model.obstacles.begin(), model.obstacles.end(),
        [&](const Obstacle& o) { return o.mesh() != nullptr && o.mesh()->nodes.contains(vertex); });
    if (found == model.obstacles.end()) continue;
    // If the obstacle's node or edge comes first, r and the normal both change sign; the gap does
    // not.
    const double sign = c.node[0] >= bodies ? -1.0 : 1.0;
    Contact out = c;
    out.node = {-1, -1, -1, -1};
    out.weight = {};
    out.count = 0;
    out.normal = sign * c.normal;
    for (int a = 0; a < c.count; ++a) {
      const Index node = c.node[static_cast<std::size_t>(a)];
      const double weight = sign * c.weight[static_cast<std::size_t>(a)];
      if (node >= bodies) {
        out.anchor -= weight * to[uz(node)];
        out.anchor_displacement -= weight * (to[uz(node)] - from[uz(node)]);
      } else {
        out.node[static_cast<std::size_t>(out.count)] = node;
        out.weight[static_cast<std::size_t>(out.count)] = weight;
        ++out.count;
      }
    }
    out.friction = found->friction;
    out.restitution = found->restitution;
    out.id.kind =
        c.id.kind == ContactKind::edge_edge ? ContactKind::edge_mesh : ContactKind::node_mesh;
    out.id.owner = static_cast<Index>(found - model.obstacles.begin());
    c = out;
  }
}

}  // namespace sinew
