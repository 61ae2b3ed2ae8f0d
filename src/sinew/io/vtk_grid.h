// Shared by legacy VTK and VTU: an unstructured grid in VTK's form and its conversion to a TetMesh.
// For vtk_read.cpp and vtu_read.cpp only.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/io/vtk_labels.h"
#include "sinew/mesh/tet_mesh.h"

namespace sinew::io {

struct VtkGrid {
  explicit VtkGrid(const LabelNames& asked)
      : cell_arrays(true, asked.tets), point_arrays(false, asked.nodes) {}

  std::vector<Vec3> points;
  std::vector<int> types;                  // VTK's cell type (cells)
  std::vector<std::int64_t> offsets;       // end of each cell in connectivity (cells)
  std::vector<std::int64_t> connectivity;  // point ids of one cell after the other
  LabelArrays cell_arrays;
  LabelArrays point_arrays;
};

// Error (input) if the arrays do not match each other or a cell cannot be used. Adds to `notes`.
TetMesh mesh_from_grid(VtkGrid grid, const std::string& name, ReadNotes& notes);

// Remedies for the data sets that hold no cells of volume.
inline constexpr std::string_view fill_vtk_surface =
    "save it as STL (in ParaView: Extract Surface, Triangulate, Save Data) and fill it: sinew-mesh "
    "NAME.stl -o NAME.vtu";
inline constexpr std::string_view fill_vtk_image =
    "save its labels as NIfTI and fill them: sinew-mesh NAME.nii -o NAME.vtu";

// Names of the arrays that Sinew writes.
inline constexpr std::string_view cell_label_name = "region";
inline constexpr std::string_view point_label_name = "label";

// The labels of tets, then faces, as one cell array; empty if neither has any.
std::vector<int> joined_cell_labels(const TetMesh& mesh);

}  // namespace sinew::io
