// MEDIT .mesh, ASCII (P. Frey, "MEDIT: an interactive mesh visualization software", INRIA RT-0253,
// 2001): MeshVersionFormatted 1 to 4 (identical as text), Dimension 3, sections in
// any order, ids from 1, comments from # to the end of the line, End optional.
// Vertices, Triangles and Tetrahedra are kept with their reference numbers as labels; other known
// sections are skipped by their count.
#pragma once

#include <string>
#include <string_view>

#include "sinew/mesh/tet_mesh.h"

namespace sinew::io {

// name: for errors. Error (input) for any other file and for a mesh without tetrahedra.
TetMesh parse_medit(std::string_view text, const std::string& name);
std::string format_medit(const TetMesh& mesh);

}  // namespace sinew::io
