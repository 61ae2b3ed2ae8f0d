#include "sinew/io/cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <span>

#include "sinew/base/error.h"

namespace sinew::io {
namespace {

using enum CellUse;

struct Row {
  int type;
  CellType cell;
};

constexpr Row gmsh_types[] = {
    {1, {"lines", 2, skip}},
    {2, {"triangles", 3, face}},
    {3, {"quadrilaterals", 4, skip}},
    {4, {"tetrahedra", 4, tet}},
    {5, {"hexahedra", 8, refuse}},
    {6, {"prisms", 6, refuse}},
    {7, {"pyramids", 5, refuse}},
    {8, {"quadratic lines", 3, skip}},
    {9, {"quadratic triangles", 6, face}},
    {10, {"quadratic quadrilaterals", 9, skip}},
    {11, {"quadratic tetrahedra", 10, tet}},
    {12, {"quadratic hexahedra", 27, refuse}},
    {13, {"quadratic prisms", 18, refuse}},
    {14, {"quadratic pyramids", 14, refuse}},
    {15, {"points", 1, skip}},
    {16, {"quadratic quadrilaterals", 8, skip}},
    {17, {"quadratic hexahedra", 20, refuse}},
    {18, {"quadratic prisms", 15, refuse}},
    {19, {"quadratic pyramids", 13, refuse}},
    {20, {"cubic triangles", 9, face}},
    {21, {"cubic triangles", 10, face}},
    {22, {"quartic triangles", 12, face}},
    {23, {"quartic triangles", 15, face}},
    {24, {"quintic triangles", 15, face}},
    {25, {"quintic triangles", 21, face}},
    {26, {"cubic lines", 4, skip}},
    {27, {"quartic lines", 5, skip}},
    {28, {"quintic lines", 6, skip}},
    {29, {"cubic tetrahedra", 20, tet}},
    {30, {"quartic tetrahedra", 35, tet}},
    {31, {"quintic tetrahedra", 56, tet}},
    {92, {"cubic hexahedra", 64, refuse}},
    {93, {"quartic hexahedra", 125, refuse}},
};

constexpr Row vtk_types[] = {
    {0, {"empty cells", 0, skip}},
    {1, {"points", 1, skip}},
    {2, {"point sets", 0, skip}},
    {3, {"lines", 2, skip}},
    {4, {"polylines", 0, skip}},
    {5, {"triangles", 3, face}},
    {6, {"triangle strips", 0, refuse}},
    {7, {"polygons", 0, refuse}},
    {8, {"pixels", 4, skip}},
    {9, {"quadrilaterals", 4, skip}},
    {10, {"tetrahedra", 4, tet}},
    {11, {"voxels", 8, refuse}},
    {12, {"hexahedra", 8, refuse}},
    {13, {"prisms", 6, refuse}},
    {14, {"pyramids", 5, refuse}},
    {15, {"pentagonal prisms", 10, refuse}},
    {16, {"hexagonal prisms", 12, refuse}},
    {21, {"quadratic lines", 3, skip}},
    {22, {"quadratic triangles", 6, face}},
    {23, {"quadratic quadrilaterals", 8, skip}},
    {24, {"quadratic tetrahedra", 10, tet}},
    {25, {"quadratic hexahedra", 20, refuse}},
    {26, {"quadratic prisms", 15, refuse}},
    {27, {"quadratic pyramids", 13, refuse}},
    {28, {"quadratic quadrilaterals", 9, skip}},
    {29, {"quadratic hexahedra", 27, refuse}},
    {42, {"polyhedra", 0, refuse}},
    {68, {"Lagrange lines", 0, skip}},
    {69, {"Lagrange triangles", 0, face}},
    {70, {"Lagrange quadrilaterals", 0, skip}},
    {71, {"Lagrange tetrahedra", 0, tet}},
    {72, {"Lagrange hexahedra", 0, refuse}},
};

CellType find(std::span<const Row> rows, int type) {
  for (const Row& row : rows) {
    if (row.type == type) return row.cell;
  }
  return {};
}

}  // namespace

CellType gmsh_cell_type(int type) {
  return find(gmsh_types, type);
}

CellType vtk_cell_type(int type) {
  return find(vtk_types, type);
}

void RefusedCells::check(const std::string& file) const {
  if (counts_.empty()) return;
  std::string list;
  for (const auto& [name, count] : counts_) {
    list += fmt::format("{}{} ({})", list.empty() ? "" : ", ", name, count);
  }
  throw Error(ErrorKind::input, fmt::format("holds cells that are not tetrahedra: {}", list),
              "mesh the volume with tetrahedra only (in Gmsh: without recombination), or split "
              "these cells into tetrahedra before (in ParaView: filter "
              "Tetrahedralize)",
              {file, 0, 0});
}

void CornerCells::remark(ReadNotes& notes) const {
  if (counts_.empty()) return;
  std::string list;
  for (const auto& [name, count] : counts_) {
    list += fmt::format("{}{} {}", list.empty() ? "" : " and ", count, name);
  }
  notes.remarks.push_back(
      list +
      " are used by their corners: nodes between corners are left out, curved edges become "
      "straight");
}

void require_tets(const TetMesh& mesh, const std::string& file) {
  if (!mesh.tets.empty()) return;
  if (mesh.faces.empty()) {
    throw Error(ErrorKind::input, "holds no tetrahedra",
                "export the volume mesh, not only its points", {file, 0, 0});
  }
  throw Error(
      ErrorKind::input,
      fmt::format("is a surface: it holds no tetrahedra, only triangles ({})", mesh.faces.size()),
      "export the volume mesh, or save the surface as STL and fill it: sinew-mesh NAME.stl -o "
      "NAME.vtu",
      {file, 0, 0});
}

void require_indexable(std::size_t count, std::string_view what, const std::string& file) {
  constexpr auto most = static_cast<std::size_t>(std::numeric_limits<Index>::max());
  if (count <= most) return;
  throw Error(ErrorKind::input,
              fmt::format("holds {} {}; at most {} can be numbered", count, what, most),
              "use a coarser mesh", {file, 0, 0});
}

void drop_zero_labels(std::vector<int>& labels) {
  if (std::all_of(labels.begin(), labels.end(), [](int label) { return label == 0; })) {
    labels.clear();
  }
}

}  // namespace sinew::io
