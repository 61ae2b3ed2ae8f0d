// TetGen .node, .ele and .face (H. Si, TetGen manual, section "File formats"): ids from 0 or 1,
// comments from # to the end of the line, optional attributes and boundary markers.
// A tet's label is its region, the last attribute; a node's and a face's label is its boundary
// marker.
#pragma once

#include <string>
#include <string_view>

#include "sinew/io/mesh_notes.h"
#include "sinew/mesh/tet_mesh.h"

namespace sinew::io {

// The texts of a set of files; an empty face text: no such file. Names: for errors.
struct TetgenText {
  std::string node, ele, face;
  std::string node_name, ele_name, face_name;
};

// Error (input) for any other pair and for a mesh without tetrahedra.
// Adds to `notes` if given.
TetMesh parse_tetgen(const TetgenText& files, ReadNotes* notes = nullptr);
// Ids from 1. `face` is empty if the mesh has no faces.
TetgenText format_tetgen(const TetMesh& mesh);

}  // namespace sinew::io
