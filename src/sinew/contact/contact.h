// A contact: a condition on the distance between a node or edge and another feature.
// contact/surfaces.h and contact/colliders.h find contacts; contact/contact_solver.h solves them in
// explicit steps, solver/constraints.h in implicit steps and rest states.
// docs/methods/contact.md.
#pragma once

#include <array>
#include <vector>

#include "sinew/base/vec.h"
#include "sinew/model/contact_id.h"

namespace sinew {

// A condition on one to four nodes. The position of the node or edge relative to the other feature
// is
//
//   r(x) = sum_a weight_a x_a - anchor,      gap(x) = normal . r(x) >= 0
//
//   node against a triangle:  weights 1, -b0, -b1, -b2       anchor 0
//   edge against an edge:     weights 1-s, s, -(1-t), -t     anchor 0
//   node against a collider:  weight 1                       anchor on the collider's surface
//
// Weights that sum to zero and a common normal conserve momentum to rounding.
struct Contact {
  std::array<Index, 4> node = {-1, -1, -1, -1};  // node ids; the first `count` are used
  std::array<double, 4> weight = {};             // [-]
  int count = 0;                                 // nodes used, 1 to 4
  Vec3 normal = Vec3::UnitY();  // [-] unit, points out of the triangle, second edge or collider
  Vec3 anchor = Vec3::Zero();   // [m] on the collider's surface, at the end of the step
  Vec3 anchor_displacement = Vec3::Zero();  // [m] of the collider's surface in the step
  double gap = 0.0;                         // [m] at the end of the step; < 0: inside
  double time_of_impact = 1.0;  // [-] in [0, 1]: the share of the step after which the gap became
                                // 0; 0: it was 0 or less from the start
  double friction = 0.0;        // [-] Coulomb's mu
  double restitution = 0.0;     // [-]
  ContactId id;                 // unique within a step
};

// The gaps below which contacts are found [m]. A plane has its own reach: its condition is the same
// at all positions of a node, so a solver that moves nodes far can use the contact at any distance.
struct ContactReach {
  ContactReach(double any) : near(any), plane(any) {}  // NOLINT: the usual case
  ContactReach(double shapes_and_surfaces, double planes)
      : near(shapes_and_surfaces), plane(planes) {}
  double near = 0.0;
  double plane = 0.0;
};

// The position of the node or edge relative to the other feature [m]: r(x) above.
inline Vec3 contact_offset(const Contact& c, const std::vector<Vec3>& x) {
  Vec3 r = -c.anchor;
  for (int a = 0; a < c.count; ++a)
    r += c.weight[static_cast<std::size_t>(a)] * x[uz(c.node[static_cast<std::size_t>(a)])];
  return r;
}

inline bool comes_before(const Contact& a, const Contact& b) {
  return a.id < b.id;
}

inline double contact_gap(const Contact& c, const std::vector<Vec3>& x) {
  return c.normal.dot(contact_offset(c, x));
}

}  // namespace sinew
