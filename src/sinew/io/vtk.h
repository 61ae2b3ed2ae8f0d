// Legacy VTK (.vtk) unstructured grids, ASCII and binary, versions 1 to 5 (VTK file formats,
// "Simple Legacy Formats"; 5.1 with OFFSETS and CONNECTIVITY). Triangles become faces; points,
// lines and quadrilaterals are skipped. Labels come from a cell array and a point array of whole
// numbers (vtk_labels.h has the rule).
#pragma once

#include <string>
#include <string_view>

#include "sinew/io/mesh_notes.h"
#include "sinew/mesh/tet_mesh.h"

namespace sinew::io {

// name: for errors. Error (input) for any other file and for a mesh without tetrahedra.
// Adds to `notes` if given.
TetMesh parse_vtk(std::string_view bytes, const std::string& name, const LabelNames& labels = {},
                  ReadNotes* notes = nullptr);
// Version 3.0, which every reader supports; cell array "region" (tets, then faces), point array
// "label".
std::string format_vtk(const TetMesh& mesh, bool binary);

}  // namespace sinew::io
