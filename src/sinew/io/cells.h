// Shared by the formats with many cell types: the types that Sinew uses, and the error for types
// that it cannot use.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>

#include "sinew/io/mesh_notes.h"
#include "sinew/mesh/tet_mesh.h"

namespace sinew::io {

enum class CellUse {
  tet,     // a tetrahedron; of a higher order: its corners, which come first
  face,    // a triangle, kept with its label; of a higher order: its corners
  skip,    // points, lines, quadrilaterals: not part of a tetrahedral mesh
  refuse,  // a volume cell that would leave a hole if it were skipped
};

struct CellType {
  std::string_view name;  // plural; empty: unknown
  int nodes = 0;          // 0: any number
  CellUse use = CellUse::refuse;
};

CellType gmsh_cell_type(int type);  // element types of the Gmsh manual, section "MSH file format"
CellType vtk_cell_type(int type);   // vtkCellType.h

// Counts the refused cells, so that one error names them all.
class RefusedCells {
 public:
  void add(std::string_view name, std::size_t count = 1) { counts_[std::string(name)] += count; }
  // Error if there are any.
  void check(const std::string& file) const;

 private:
  std::map<std::string, std::size_t> counts_;
};

// Counts the tetrahedra and triangles of a higher order, which are used by their corners.
class CornerCells {
 public:
  void add(std::string_view name) { ++counts_[std::string(name)]; }
  // A remark that names them, if there are any.
  void remark(ReadNotes& notes) const;

 private:
  std::map<std::string, std::size_t> counts_;
};

// Error if the mesh has no tetrahedra; the message says whether it has a surface.
void require_tets(const TetMesh& mesh, const std::string& file);
// Error if there are more than an Index can number.
void require_indexable(std::size_t count, std::string_view what, const std::string& file);
// Removes labels if all of them are 0.
void drop_zero_labels(std::vector<int>& labels);

}  // namespace sinew::io
