// Gmsh .msh 2.x and 4.1, ASCII and binary, both byte orders (Gmsh reference manual, section "MSH
// file format" and its appendix on the legacy formats). Node ids may be sparse.
// A cell's label is the tag of its physical group (the first one, if its entity is in several;
// without the sign by which 4.1 marks an entity that is turned around), or the tag of its
// elementary entity where it is in none. Node labels cannot be held.
#pragma once

#include <string>
#include <string_view>

#include "sinew/mesh/tet_mesh.h"

namespace sinew::io {

enum class GmshVersion { v2_2, v4_1 };

// name: for errors. Error (input) for everything that is not such a file, or holds no tetrahedra.
TetMesh parse_gmsh(std::string_view bytes, const std::string& name);
// Labels are written as physical groups; those that are not positive, which no group can have, as
// the tag of an entity in no group. Binary is in the byte order of this machine.
std::string format_gmsh(const TetMesh& mesh, GmshVersion version, bool binary);

}  // namespace sinew::io
