// The narrow phase of contact: tests a node against a surface, and an edge against an edge. The
// rules are in docs/methods/contact.md.
#pragma once

#include <span>
#include <vector>

#include "sinew/contact/contact.h"
#include "sinew/contact/nearest.h"
#include "sinew/model/model.h"

namespace sinew {

// The positions of all nodes at both ends of a step, and the gap below which a pair touches [m].
struct Moves {
  const std::vector<Vec3>& from;
  const std::vector<Vec3>& to;
  double reach = 0.0;
};

// The plane of a triangle at given positions: its unit normal (0 if the triangle has no area) and
// the length of the cross product of its sides, twice the area.
struct Plane {
  Vec3 normal = Vec3::Zero();  // [-]
  double length = 0.0;         // [m2]
};

inline Plane plane_of(const std::vector<Vec3>& x, const Triangle& t) {
  const Vec3& a = x[uz(t[0])];
  const Vec3 n = (x[uz(t[1])] - a).cross(x[uz(t[2])] - a);
  const double length = n.norm();
  return {length > 0.0 ? Vec3(n / length) : Vec3(Vec3::Zero()), length};
}

// The triangles that a node may be in contact with.
struct NearTriangles {
  std::span<const Index> triangle;
  // Lower bounds of their distances from the node when the list was made [m], ascending; empty:
  // unknown.
  std::span<const float> far;
  double moved = 0.0;  // upper bound of their motion relative to the node since then [m]
};

// near: no contact, but within node_range at the end of the step.
enum class NodeProximity { none, near, contact };

class NarrowPhase {
 public:
  // depth_share: the largest depth of a node inside a surface that is still resolved, as a share of
  // the local size (size of the triangles). ccd_share: the largest relative motion of a pair in a
  // step that needs no CCD, as a share of the same size. self_share: two places of one body touch
  // only below this share of their rest distance.
  static constexpr double depth_share = 0.35;
  static constexpr double ccd_share = 0.15;
  static constexpr double self_share = 0.25;
  // Bends of edges [rad]. A sharp edge (bend above `sharp`, within one body above `sharp_to_self`)
  // can touch all edges with a bend above `concave`. Of two edges that touch, one is sharp.
  static constexpr double sharp = 0.21;
  static constexpr double sharp_to_self = 0.6;
  static constexpr double concave = -0.09;

  explicit NarrowPhase(const Model& model);

  // If a node is farther than this from an owner's surface at the end of the step, it can only
  // touch triangles that it passed through during the step.
  double node_range(Index node_slot, Index owner, double reach) const;
  double edge_range(Index edge, Index owner, double reach) const;
  bool is_sharp(Index edge, bool self) const {
    return surface_.edge_bend[uz(edge)] > (self ? sharp_to_self : sharp);
  }

  // The contact of a node with an owner's surface. `triangles` holds at least the triangles within
  // node_range at either end of the step, and those that the node may hit during the step. The node
  // may belong to that owner. `planes` (triangles) holds the planes of these triangles and of those
  // around the node, at the end of the step. `skip_ccd`: no pair of them moves far enough to need
  // CCD.
  NodeProximity node_contact(Index node_slot, Index owner, const NearTriangles& triangles,
                             std::span<const Plane> planes, bool skip_ccd, const Moves& moves,
                             Contact& contact) const;

  // The contact of edge a with edge b, whose owner becomes the contact's. Returns false if there is
  // none.
  bool edge_contact(Index a, Index b, bool skip_ccd, const Moves& moves, Contact& contact) const;

  // Neighbours on a surface: the triangle is around the node or around one of its neighbours; the
  // edges share a node or have nodes that are neighbours. Neighbours never touch: they are always
  // near each other, so their distance does not indicate a fold.
  bool adjoin(Index node_slot, const Triangle& t) const;
  bool adjoin(const Edge& a, const Edge& b) const;
  // The nodes of the triangles around a node, ascending.
  std::span<const Index> neighbours(Index node_slot) const {
    const auto begin = uz(neighbour_start_[uz(node_slot)]);
    return std::span<const Index>(neighbour_)
        .subspan(begin, uz(neighbour_start_[uz(node_slot) + 1]) - begin);
  }
  Index slot_of(Index node) const { return slot_of_[uz(node)]; }  // -1: not on a surface
  // Whether an edge can be in contact with any other edge; at least one edge of a pair must be
  // sharp.
  bool may_contact(Index edge) const {
    return surface_.edge_bend[uz(edge)] > concave && surface_.edge_triangles[uz(edge)][1] >= 0;
  }

  // Whether a node and a triangle, or two edges, of one body cannot touch at this distance [m] or a
  // larger one.
  bool node_too_far(Index node_slot, Index triangle, double distance) const;
  bool edges_too_far(Index a, Index b, double distance) const;

  // The relative motion [m] up to which pairs of two owners need no CCD.
  double ccd_motion(Index a, Index b) const;

  const ContactSurface& surface() const { return surface_; }
  // The distance of a node from a triangle, or of two edges, in the rest shape [m].
  double rest_distance(Index node, const Triangle& t) const;
  double rest_distance(const Edge& a, const Edge& b) const;

 private:
  struct Near {
    Index triangle = -1;
    OnTriangle on;
    double side = 0.0;          // signed distance from the triangle's plane: > 0 in front [m]
    Vec3 plane = Vec3::Zero();  // its normal, a unit vector
    bool inside = false;
    double distance() const { return std::sqrt(on.distance2); }
    void keep_nearer(const Near& other);
  };
  // The nearest triangle of a set, and the nearest one that can be in contact with the node.
  struct Nearest {
    Near any;
    Near fit;
  };
  template <typename PlaneOf>
  Nearest nearest(Index slot, bool self, const NearTriangles& triangles, const PlaneOf& plane_of,
                  const std::vector<Vec3>& x, const std::vector<Vec3>& from, double range) const;
  bool slit(Index slot, Index t, double at_rest) const;
  bool self_pair_counts(Index slot, Index t, const OnTriangle& on, double side,
                        const std::vector<Vec3>& from) const;
  bool on_boundary(Index t, const OnTriangle& on) const;
  bool node_contact_of(Index slot, const Near& near, double range, const Moves& moves,
                       Contact& contact) const;
  double pair_depth(Index slot, Index t) const {
    return depth_share * std::min(surface_.node_size[uz(slot)], surface_.triangle_size[uz(t)]);
  }
  double edge_size(Index edge) const;
  bool supports(Index edge, const Vec3& n, const Moves& moves, double t, double slack) const;

  ContactSurface surface_;
  std::vector<Index> neighbour_start_;     // offsets into neighbour_ (node slots + 1)
  std::vector<Index> neighbour_;           // nodes around each node, ascending
  std::vector<Index> slot_of_;             // -1: not on a surface (nodes of the model)
  std::vector<Vec3> rest_;                 // [m] (nodes of the model)
  std::vector<Plane> rest_plane_;          // (triangles)
  std::vector<Vec3> rest_normal_;          // [-] unit (node slots)
  std::vector<Index> triangle_owner_;      // (triangles)
  std::vector<double> largest_size_;       // of the owner's triangles [m] (owners)
  std::vector<double> smallest_size_;      // [m] (owners)
  std::vector<std::array<char, 3>> open_;  // 1: no triangle across the edge opposite (triangles)
  std::vector<char> rim_;                  // 1: on such an edge (nodes of the model)
  double friction_ = 0.0;
  double restitution_ = 0.0;
};

}  // namespace sinew
