// A mesh from a file and into a file, the format chosen by the ending of its name.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sinew/io/gmsh.h"
#include "sinew/io/vtu.h"
#include "sinew/mesh/tet_mesh.h"

namespace sinew::io {

// .mesh .msh .node .ele .vtk .vtu, case ignored. TetGen's pair may be named by either file or by
// its stem; its .face is read if it is there.
// Indices are in range afterwards; geometry is not looked at (mesh/doctor.h does that).
// Error (input) names the file, the line, what is wrong and the remedy; Error (io) what the system
// refused.
TetMesh read_mesh(const std::filesystem::path& path);

struct WriteOptions {
  bool binary = false;  // Gmsh and legacy VTK: bytes instead of text
  GmshVersion gmsh = GmshVersion::v4_1;
  VtuEncoding vtu = VtuEncoding::zlib;
};

// The same endings. Positions come back bit by bit, and so do the labels that the format can hold:
// all of tets and faces; of nodes in all but Gmsh. No part of a file is ever left (file_io.h).
// TetGen: NAME.node, NAME.ele, and NAME.face where there are faces; an old NAME.face that does not
// belong to them is removed.
void write_mesh(const std::filesystem::path& path, const TetMesh& mesh,
                const WriteOptions& options = {});

// The endings that can be read and written, for messages: {".mesh", ...}.
const std::vector<std::string>& mesh_endings();

// Whether the name has one of these endings, case ignored.
bool is_mesh_name(const std::filesystem::path& path);

}  // namespace sinew::io
