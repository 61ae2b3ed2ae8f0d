// Gmsh .msh 2.x and 4.1, ASCII and binary, both byte orders (Gmsh reference manual, section "MSH
// file format" and its appendix on the legacy formats). Node ids may be sparse. A cell's label is
// the tag of its physical group (the first one if it is in several, without the sign by which 4.1
// marks a reversed entity), or the tag of its elementary entity if it is in no group; a part of a
// partitioned mesh has those of its parent. The format has no node labels.
#pragma once

#include <string>
#include <string_view>

#include "sinew/io/mesh_notes.h"
#include "sinew/mesh/tet_mesh.h"

namespace sinew::io {

enum class GmshVersion { v2_2, v4_1 };

// name: for errors. Error (input) for any other file and for a mesh without tetrahedra.
// labels: gmsh:physical or gmsh:geometrical takes one of the two tags. Adds to `notes` if given.
TetMesh parse_gmsh(std::string_view bytes, const std::string& name, const LabelNames& labels = {},
                   ReadNotes* notes = nullptr);
// Labels are written as physical groups. Labels that are not positive, which no group can have, are
// written as the tag of an entity without group. Binary is in the byte order of this machine.
std::string format_gmsh(const TetMesh& mesh, GmshVersion version, bool binary);

}  // namespace sinew::io
