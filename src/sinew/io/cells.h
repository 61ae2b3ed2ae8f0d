// What the formats with many cell types share: which types Sinew uses, and one clear refusal of
// those that it cannot.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>

#include "sinew/mesh/tet_mesh.h"

namespace sinew::io {

enum class CellUse {
  tet,
  face,    // a triangle, kept with its label
  skip,    // points, lines, quadrilaterals: not part of a tetrahedral mesh
  refuse,  // a volume cell or curved cell that would leave a hole if it was skipped
};

struct CellType {
  std::string_view name;  // plural; empty: unknown
  int nodes = 0;          // 0: any number
  CellUse use = CellUse::refuse;
};

CellType gmsh_cell_type(int type);  // element types of the Gmsh manual, section "MSH file format"
CellType vtk_cell_type(int type);   // vtkCellType.h

// Counts the cells that must be refused, so that one error can name them all.
class RefusedCells {
 public:
  void add(std::string_view name, std::size_t count = 1) { counts_[std::string(name)] += count; }
  // Error where there are any.
  void check(const std::string& file) const;

 private:
  std::map<std::string, std::size_t> counts_;
};

// Error where the mesh has no tetrahedra; it then says whether it has a surface.
void require_tets(const TetMesh& mesh, const std::string& file);
// Error where there are more than an Index can number.
void require_indexable(std::size_t count, std::string_view what, const std::string& file);
// Labels that are all 0 are no labels.
void drop_zero_labels(std::vector<int>& labels);

}  // namespace sinew::io
