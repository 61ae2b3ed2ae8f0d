// What legacy VTK and VTU share: an unstructured grid as VTK stores it, which of its arrays are
// labels, and the way to a TetMesh. For vtk.cpp and vtu_read.cpp only.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/mesh/tet_mesh.h"

namespace sinew::io {

// The best label array met so far, of the cells or of the points.
struct LabelArray {
  std::string name;
  int rank = -1;               // place in the list of names; lower is better; -1: none yet
  std::vector<double> values;  // whole numbers, checked when the mesh is made

  // Whether an array of this name (case ignored) is a label, and a better one than what is here.
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

// Error (input) where the arrays do not fit each other or a cell cannot be used.
TetMesh mesh_from_grid(VtkGrid grid, const std::string& name);

// The arrays that Sinew itself writes.
inline constexpr std::string_view cell_label_name = "region";
inline constexpr std::string_view point_label_name = "label";

// The labels of tets, then faces, as one cell array; empty where neither has any.
std::vector<int> joined_cell_labels(const TetMesh& mesh);

}  // namespace sinew::io
