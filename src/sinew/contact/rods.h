// Contacts of rods with triangles. A rod is a segment with a radius, or a ball: a part of a shape
// that could slip between the nodes of a surface.
#pragma once

#include <vector>

#include "sinew/contact/contact.h"
#include "sinew/model/model.h"

namespace sinew {

// A rod over a step: all points within `radius` of the segment from a to b. Of a rod that is no
// ball only the part between its ends counts: its ends are balls of their own.
struct MovingRod {
  Vec3 a0 = Vec3::Zero(), b0 = Vec3::Zero();  // at the start of the step [m]
  Vec3 a1 = Vec3::Zero(), b1 = Vec3::Zero();  // at its end [m]
  double radius = 0.0;                        // [m] > 0
  bool ball = true;
};

// A rod of a shape that moves between two poses.
MovingRod moving_rod(const shapes::Rod& rod, const Pose& before, const Pose& after);

// Adds the contacts of a rod with the triangles `near` of the skin (indices into its triangles):
// where the distance between the segment and a triangle is smallest, within it or on an edge, and
// the gap at the end is below `reach`, or where they first met on the way; an edge counts once.
// Contacts with a single node are left out: nodes are looked at on their own. Filled: node, weight,
// count, normal, anchor, gap, and of the id the kind and the feature.
void add_rod_contacts(const MovingRod& rod, const Skin& skin, const std::vector<Index>& near,
                      const std::vector<Vec3>& from, const std::vector<Vec3>& to, double reach,
                      std::vector<Contact>& out);

}  // namespace sinew
