// Builds the surface of the contacts of bodies and rigid meshes (model/contact_surface.h).
#pragma once

#include <span>

#include "sinew/model/model.h"

namespace sinew {

// Fills Model::surface with the surfaces of all bodies, from Model::tets and ::bodies, and of all
// obstacles that are meshes. It stays empty if there is neither Model::body_contact nor such an
// obstacle. Rest lengths come from Model::rest_position.
void build_contact_surface(Model& model);

// Appends a rigid mesh as the next owner, after build_contact_surface(). The node ids of the
// triangles are higher than those of every owner before; corners are counter-clockwise seen from
// outside.
void add_rigid_contact_surface(Model& model, std::span<const Triangle> triangles);

}  // namespace sinew
