// Rods against triangles: segments with a radius (balls, where both ends are one), the parts of
// tools that may slip between the nodes of a surface.
#pragma once

#include <vector>

#include "sinew/contact/contact.h"
#include "sinew/model/model.h"

namespace sinew {

// What is within `radius` of the segment from a to b, over a step. Of a segment that is not a ball
// only what lies between its ends counts: its ends are balls of their own.
struct Rod {
  Vec3 a0 = Vec3::Zero(), b0 = Vec3::Zero();  // at the start of the step [m]
  Vec3 a1 = Vec3::Zero(), b1 = Vec3::Zero();  // at its end [m]
  double radius = 0.0;                        // [m] > 0
  bool ball = true;
};

// The rods of an obstacle: a sphere; both ends and the side of a capsule (those only where the
// radius is less than twice `longest_edge` [m] of the body: nodes are enough for larger ones);
// corners and edges of a box, rounded by a tenth of its smallest side.
std::vector<Rod> rods_of(const Obstacle& obstacle, const Pose& before, const Pose& after,
                         double longest_edge);

// Adds the contacts of a rod with the triangles `near` of the skin (indices into its triangles):
// where the distance between the segment and a triangle is smallest, within it or on an edge, and
// the gap at the end is below `reach`, or where they first met on the way; an edge counts once.
// Contacts with a single node are left out: nodes are looked at on their own. Filled: node, weight,
// count, normal, anchor, gap, and of the id the kind and the feature.
void add_rod_contacts(const Rod& rod, const Skin& skin, const std::vector<Index>& near,
                      const std::vector<Vec3>& from, const std::vector<Vec3>& to, double reach,
                      std::vector<Contact>& out);

}  // namespace sinew
