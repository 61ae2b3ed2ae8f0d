// Contacts of bodies with rigid planes, spheres, capsules and boxes. docs/methods/obstacles.md.
#pragma once

#include <vector>

#include "sinew/contact/contact.h"
#include "sinew/model/model.h"

namespace sinew {

// Adds the surface of the bodies that find_collider_contacts() looks at: Model::skin. Call after
// the last add_body; does nothing where there is one already.
void build_skin(Model& model);

// Contacts of a step from positions `from` at time t0 to `to` at time t1 [m] (nodes) with all hard
// obstacles but meshes, into `out` (which is cleared), sorted by id:
//
//   node against a shape: every node of the surface whose gap at `to` is below `reach` [m], and
//   those
//     that went into or through the shape on the way, seen from the moving shape. Where the nearest
//     way out is not to the side that the node came from, the normal is the one of where it came
//     in.
//   triangle against a sphere, a capsule, the edges or the corners of a box: those smaller than the
//     triangles slip between their nodes. One to three nodes with barycentric weights. Spheres and
//     capsules only where their radius is less than twice the body's longest edge.
//
// Nodes whose motion is given do not touch; nor does a triangle with no free corner. The result
// depends on the arguments only.
void find_collider_contacts(const Model& model, const std::vector<Vec3>& from,
                            const std::vector<Vec3>& to, double t0, double t1, double reach,
                            std::vector<Contact>& out);

// Contacts with rigid meshes as SurfaceContacts finds them, between nodes, into contacts with a
// collider: what is touched is the obstacle, whose nodes go into `anchor` and `way`; friction and
// restitution are its own. What touches no mesh stays as it is.
void name_rigid_contacts(const Model& model, const std::vector<Vec3>& from,
                         const std::vector<Vec3>& to, std::vector<Contact>& contacts);

// How the bodies stand to an obstacle at positions x and a time: the deepest node [m] (0: none is
// inside) and how many nodes are inside or within `reach` [m].
struct ColliderReading {
  double depth = 0.0;
  Index contacts = 0;
};
ColliderReading read_collider(const Model& model, const Obstacle& obstacle,
                              const std::vector<Vec3>& x, double time, double reach);

}  // namespace sinew
