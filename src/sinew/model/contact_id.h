// The identity of a contact: which features touch. It stays the same from step to step, so a
// contact can start from its force of the step before (warm start).
#pragma once

#include <compare>
#include <cstdint>

#include "sinew/base/vec.h"

namespace sinew {

// The kind of the two features that touch, in the order in which the contact solver visits them.
enum class ContactKind : std::int32_t {
  node_shape,     // feature: a node; partner: -1. Owner: an obstacle with a shape
  edge_rod,       // feature: an edge of the skin; partner: a rod of the owner, an obstacle
  triangle_rod,   // feature: a triangle of the skin; partner: a rod of the owner, an obstacle
  node_mesh,      // feature: a node of the surface; partner: a triangle. Owner: an obstacle, a mesh
  edge_mesh,      // feature and partner: edges of the surface. Owner: an obstacle, a mesh
  node_triangle,  // feature: a node of the surface; partner: a triangle. Owner: a body
  edge_edge,      // feature and partner: edges of the surface. Owner: a body
};

struct ContactId {
  ContactKind kind = ContactKind::node_shape;
  Index owner = -1;    // the touched obstacle or body: its index, according to the kind
  Index feature = -1;  // the feature that touches the owner
  Index partner = -1;  // the part of the owner that is touched

  auto operator<=>(const ContactId&) const = default;

  // Whether the same feature touches the same owner, possibly at another part: for example a node
  // that has moved on to the next triangle.
  bool same_feature(const ContactId& other) const {
    return kind == other.kind && owner == other.owner && feature == other.feature;
  }

  // Whether an obstacle with a shape is touched, rather than a mesh or a body.
  bool with_shape() const { return kind < ContactKind::node_mesh; }

  // The touched obstacle, index into Model::obstacles; -1: a body is touched.
  Index obstacle() const {
    switch (kind) {
      case ContactKind::node_shape:
      case ContactKind::edge_rod:
      case ContactKind::triangle_rod:
      case ContactKind::node_mesh:
      case ContactKind::edge_mesh:
        return owner;
      case ContactKind::node_triangle:
      case ContactKind::edge_edge:
        return -1;
    }
    return -1;
  }
};

}  // namespace sinew
