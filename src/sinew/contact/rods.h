// Contacts of rods with triangles. A rod is a segment with a radius, or a ball: a part of a shape
// that could slip between the nodes of a surface.
#pragma once

#include <vector>

#include "sinew/contact/contact.h"
#include "sinew/model/model.h"

namespace sinew {

// A rod during a step: all points within `radius` of the segment from a to b. If the rod is not a
// ball, only the part between its ends counts: the ends are separate balls.
struct MovingRod {
  Vec3 a0 = Vec3::Zero(), b0 = Vec3::Zero();  // at the start of the step [m]
  Vec3 a1 = Vec3::Zero(), b1 = Vec3::Zero();  // at its end [m]
  double radius = 0.0;                        // [m] > 0
  bool ball = true;
};

// A rod of a shape that moves between two poses.
MovingRod moving_rod(const shapes::Rod& rod, const Pose& before, const Pose& after);

// Adds the contacts of a rod with the triangles `near` of the skin (indices into its triangles).
// The contact is at the nearest points of segment and triangle, within the triangle or on an edge,
// if the gap at the end is below `reach`, or at the first hit during the step. An edge counts once.
// Contacts with a single node are left out: nodes are tested separately. The function fills node,
// weight, count, normal, anchor and gap, and kind and feature of the id.
void add_rod_contacts(const MovingRod& rod, const Skin& skin, const std::vector<Index>& near,
                      const std::vector<Vec3>& from, const std::vector<Vec3>& to, double reach,
                      std::vector<Contact>& out);

}  // namespace sinew
