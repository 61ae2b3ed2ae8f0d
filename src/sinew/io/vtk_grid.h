// Shared by legacy VTK and VTU: an unstructured grid in VTK's form, the choice of its label arrays,
// and the conversion to a TetMesh. For vtk_read.cpp and vtu_read.cpp only.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/mesh/tet_mesh.h"

namespace sinew::io {

// The best label array found so far, of the cells or of the points.
struct LabelArray {
  std::string name;
  int rank = -1;               // index in the list of names; lower is better; -1: none yet
  std::vector<double> values;  // whole numbers, checked when the mesh is built

  // Whether an array of this name (case ignored) is a label, and better than the present one.
  bool wants(std::string_view array_name) const;
  void set(std::string_view array_name, std::vector<double> array_values);
};

struct VtkGrid {
  std::vector<Vec3> points;
  std::vector<int> types;                  // VTK's cell type (cells)
  std::vector<std::int64_t> offsets;       // end of each cell in connectivity (cells)
  std::vector<std::int64_t> connectivity;  // point ids of one cell after the other
  LabelArray cell_label;
  LabelArray point_label;
};

// Error (input) if the arrays do not match each other or a cell cannot be used.
TetMesh mesh_from_grid(VtkGrid grid, const std::string& name);

// Names of the arrays that Sinew writes.
inline constexpr std::string_view cell_label_name = "region";
inline constexpr std::string_view point_label_name = "label";

// The labels of tets, then faces, as one cell array; empty if neither has any.
std::vector<int> joined_cell_labels(const TetMesh& mesh);

}  // namespace sinew::io
