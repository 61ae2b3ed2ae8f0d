// Reads and writes a mesh; the extension of the file's name gives the format.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sinew/io/gmsh.h"
#include "sinew/io/mesh_notes.h"
#include "sinew/io/vtu.h"
#include "sinew/mesh/tet_mesh.h"

namespace sinew::io {

// .mesh .msh .node .ele .vtk .vtu, case ignored. TetGen's pair may be named by either file or by
// its stem; its .face is read if it exists.
// Indices are in range afterwards; the geometry is not checked (mesh/doctor.h does that).
// Error (input) names the file, the line, the fault and the remedy; Error (io) the refusal of the
// system.
//
// labels: the arrays or groups that the labels come from; Error (input) if the file has no such
// thing. Adds to `notes` if given.
TetMesh read_mesh(const std::filesystem::path& path, const LabelNames& labels = {},
                  ReadNotes* notes = nullptr);

struct WriteOptions {
  bool binary = false;  // Gmsh and legacy VTK: bytes instead of text
  GmshVersion gmsh = GmshVersion::v4_1;
  VtuEncoding vtu = VtuEncoding::zlib;
};

// The same extensions. A round trip keeps the bits of positions, and the labels that the format can
// hold: those of tets and faces in all formats, those of nodes in all but Gmsh. Files are complete
// or absent (file_io.h). TetGen: NAME.node, NAME.ele, and NAME.face if there are faces; an old
// NAME.face is removed otherwise.
void write_mesh(const std::filesystem::path& path, const TetMesh& mesh,
                const WriteOptions& options = {});

// The extensions that can be read and written, for messages: {".mesh", ...}.
const std::vector<std::string>& mesh_endings();

// Error (input) that names what the file is and the remedy, for a file whose extension says that it
// holds no tetrahedra that can be read: a surface, an image, a format that another program
// converts. Returns for other extensions.
void refuse_other_format(const std::filesystem::path& path);

// Whether the name has one of these extensions, case ignored.
bool is_mesh_name(const std::filesystem::path& path);

}  // namespace sinew::io
