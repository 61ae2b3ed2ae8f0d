// VTU: an unstructured grid in VTK's XML format (VTK file formats, "XML File Formats").
//
// Read: ASCII, Base64 inline, appended Base64 and appended raw, each plain or zlib-compressed,
// UInt32 and UInt64 headers, both byte orders, one Piece. Triangles become faces; labels as in
// vtk.h.
// Written: one Piece, tets first, then faces. ParaView and meshio read it.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/base/words.h"
#include "sinew/io/mesh_notes.h"
#include "sinew/mesh/tet_mesh.h"

namespace sinew::io {

// name: for errors. Error (input) for any other file and for a mesh without tetrahedra.
// Adds to `notes` if given.
TetMesh parse_vtu(std::string_view bytes, const std::string& name, const LabelNames& labels = {},
                  ReadNotes* notes = nullptr);

enum class VtuEncoding { ascii, base64, zlib };  // zlib: compressed, then Base64
constexpr std::array<Word<VtuEncoding>, 3> words_of(VtuEncoding) {
  return {{{VtuEncoding::zlib, "zlib"},
           {VtuEncoding::base64, "base64"},
           {VtuEncoding::ascii, "ascii"}}};
}

template <typename T>
struct VtuArray {
  std::string name;
  std::span<const T> values;  // (points) or (cells); must live until the file is written
};

// The content of one file. Nothing is copied: the spans must live until it is written.
struct VtuData {
  std::span<const Vec3> points;     // positions (points)
  std::span<const Tet> tets;        // point ids (tets)
  std::span<const Triangle> faces;  // point ids (faces); may be empty
  std::vector<VtuArray<double>> point_scalars;
  std::vector<VtuArray<Vec3>> point_vectors;
  std::vector<VtuArray<int>> point_integers;
  std::vector<VtuArray<double>> cell_scalars;  // cells: the tets, then the faces
  std::vector<VtuArray<Mat3>> cell_tensors;    // symmetric: XX, YY, ZZ, XY, YZ, XZ are written
  std::vector<VtuArray<int>> cell_integers;
  std::optional<double> time;  // [s]; written as the field array TimeValue
  // The result of format_vtu_cells for the same tets, faces and encoding, or empty. The cells of a
  // time series do not change, and are most of the work of a compressed frame.
  std::string_view encoded_cells;
};

struct VtuOptions {
  VtuEncoding encoding = VtuEncoding::zlib;
  // Positions and real arrays as Float64, for a mesh whose round trip must keep all bits. Float32
  // halves the size of a frame for display.
  bool float64 = false;
};

// Error (internal) if an array's size is not that of the points or cells.
std::string format_vtu(const VtuData& data, const VtuOptions& options = {});
std::string format_vtu_cells(std::span<const Tet> tets, std::span<const Triangle> faces,
                             VtuEncoding encoding);

// A mesh with its labels as cell array "region" and point array "label", positions in Float64.
std::string format_vtu(const TetMesh& mesh, VtuEncoding encoding);

}  // namespace sinew::io
