// Contacts of bodies with the shapes of obstacles (model/shapes/), including the ground.
// docs/methods/obstacles.md.
#pragma once

#include <vector>

#include "sinew/contact/contact.h"
#include "sinew/model/controls.h"
#include "sinew/model/model.h"

namespace sinew {

// Builds Model::skin: the surface of the bodies that find_collider_contacts() uses. Call it after
// the last add_body; it does nothing if the skin has been built already.
void build_skin(Model& model);

// Contacts of a step from positions `from` at time t0 to `to` at time t1 [m] (nodes) with all hard
// obstacles except meshes, at the poses that the controls give them. They are written to `out`
// (which is cleared), sorted by id:
//
//   node against a shape: every node of the surface whose gap at `to` is below `reach` [m], and
//     every node that entered or passed through the shape during the step, relative to the moving
//     shape. If the nearest surface point is not on the side that the node came from, the normal
//     is that of the point of entry.
//   triangle against a rod of a shape (a small sphere or capsule, the edges and corners of a box or
//     cylinder): a shape that is smaller than the triangles could slip between their nodes. The
//     contact has one to three nodes with barycentric weights. The shape gives its rods for the
//     longest edge of a body.
//
// Nodes whose motion is prescribed and triangles without a free corner have no contacts. The result
// depends on the arguments only.
void find_collider_contacts(const Model& model, const Controls& controls,
                            const std::vector<Vec3>& from, const std::vector<Vec3>& to, double t0,
                            double t1, const ContactReach& reach, std::vector<Contact>& out);

// Turns contacts between nodes of bodies and of rigid meshes (SurfaceContacts) into contacts with
// an obstacle: `anchor` and `anchor_displacement` replace the mesh's nodes; friction and
// restitution are those of the obstacle. Other contacts stay as they are.
void name_rigid_contacts(const Model& model, const std::vector<Vec3>& from,
                         const std::vector<Vec3>& to, std::vector<Contact>& contacts);

}  // namespace sinew
