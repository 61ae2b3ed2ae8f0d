// Contacts of bodies with the shapes of obstacles (model/shapes/), the ground among them.
// docs/methods/obstacles.md.
#pragma once

#include <vector>

#include "sinew/contact/contact.h"
#include "sinew/model/controls.h"
#include "sinew/model/model.h"

namespace sinew {

// Adds the surface of the bodies that find_collider_contacts() looks at: Model::skin. Call after
// the last add_body; does nothing where there is one already.
void build_skin(Model& model);

// Contacts of a step from positions `from` at time t0 to `to` at time t1 [m] (nodes) with all hard
// obstacles but meshes, where the controls have them, into `out` (which is cleared), sorted by id:
//
//   node against a shape: every node of the surface whose gap at `to` is below `reach` [m], and
//     every node that went into or through the shape on the way, relative to the moving shape. If
//     the shortest way out is not on the side that the node came from, the normal is that of the
//     place where it entered.
//   triangle against a rod of a shape (a small sphere or capsule, the edges and corners of a box or
//     cylinder): what is smaller than the triangles slips between their nodes. One to three nodes
//     with barycentric weights. The shape says which rods it has for a body's longest edge.
//
// Nodes whose motion is given do not touch; nor does a triangle with no free corner. The result
// depends on the arguments only.
void find_collider_contacts(const Model& model, const Controls& controls,
                            const std::vector<Vec3>& from, const std::vector<Vec3>& to, double t0,
                            double t1, const ContactReach& reach, std::vector<Contact>& out);

// Turns contacts between nodes of bodies and of rigid meshes (SurfaceContacts) into contacts with
// an obstacle: `anchor` and `way` replace the mesh's nodes; friction and restitution are those of
// the obstacle. Other contacts stay as they are.
void name_rigid_contacts(const Model& model, const std::vector<Vec3>& from,
                         const std::vector<Vec3>& to, std::vector<Contact>& contacts);

}  // namespace sinew
