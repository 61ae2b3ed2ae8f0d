#include "sinew/io/vtk_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "sinew/base/error.h"
#include "sinew/io/cells.h"

namespace sinew::io {
namespace {

class GridReader {
 public:
  GridReader(VtkGrid grid, const std::string& name, ReadNotes& notes)
      : grid_(std::move(grid)), name_(name), notes_(notes) {}

  TetMesh mesh() {
    check_shape();
    require_indexable(grid_.points.size(), "points", name_);
    require_indexable(grid_.types.size(), "cells", name_);
    const std::vector<int> labels = grid_.cell_arrays.choose(grid_.types.size(), name_, notes_);
    mesh_.node_label = grid_.point_arrays.choose(grid_.points.size(), name_, notes_);
    mesh_.nodes = std::move(grid_.points);
    std::int64_t start = 0;
    for (std::size_t i = 0; i < grid_.types.size(); ++i) {
      add_cell(i, start, labels.empty() ? nullptr : &labels[i]);
      start = grid_.offsets[i];
    }
    refused_.check(name_);
    quadratic_.remark(notes_);
    require_tets(mesh_, name_);
    drop_zero_labels(mesh_.node_label);
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(std::string message, std::string remedy) const {
    throw Error(ErrorKind::input, std::move(message), std::move(remedy), {name_, 0, 0});
  }

  void check_shape() const {
    if (grid_.offsets.size() != grid_.types.size()) {
      fail(
          fmt::format("holds {} cells but {} cell types", grid_.offsets.size(), grid_.types.size()),
          "every cell needs one type: export the file again");
    }
    std::int64_t start = 0;
    for (std::size_t i = 0; i < grid_.offsets.size(); ++i) {
      const std::int64_t end = grid_.offsets[i];
      if (end < start || end > static_cast<std::int64_t>(grid_.connectivity.size())) {
        fail(fmt::format("cell {} ends at {} in the connectivity; {} to {} was expected", i, end,
                         start, grid_.connectivity.size()),
             "offsets rise from cell to cell and end with the connectivity: export the file again");
      }
      start = end;
    }
  }

  void add_cell(std::size_t i, std::int64_t start, const int* label) {
    const int type = grid_.types[i];
    const CellType cell = vtk_cell_type(type);
    const std::int64_t nodes = grid_.offsets[i] - start;
    if (cell.use == CellUse::refuse) {
      refused_.add(cell.name.empty() ? fmt::format("cells of VTK type {}", type)
                                     : std::string(cell.name));
    } else if (cell.use == CellUse::tet) {
      mesh_.tets.push_back(corners<4>(i, start, nodes, cell, "a tetrahedron"));
      if (label != nullptr) mesh_.tet_label.push_back(*label);
    } else if (cell.use == CellUse::face) {
      mesh_.faces.push_back(corners<3>(i, start, nodes, cell, "a triangle"));
      mesh_.face_label.push_back(label == nullptr ? 0 : *label);
    }
  }

  template <std::size_t count>
  std::array<Index, count> corners(std::size_t i, std::int64_t start, std::int64_t nodes,
                                   const CellType& type, std::string_view kind) {
    const auto wanted = std::max(count, static_cast<std::size_t>(type.nodes));
    if (type.nodes == 0 ? nodes < static_cast<std::int64_t>(count)
                        : nodes != static_cast<std::int64_t>(wanted)) {
      fail(fmt::format("cell {} is {} but has {} points, {} were expected", i, kind, nodes, wanted),
           "cell types and connectivity do not belong together: export the file again");
    }
    std::array<Index, count> cell{};
    for (std::size_t k = 0; k < count; ++k) {
      const std::int64_t id = grid_.connectivity[static_cast<std::size_t>(start) + k];
      if (id < 0 || id >= static_cast<std::int64_t>(mesh_.nodes.size())) {
        fail(fmt::format("cell {}, {}, names point {}; the file has points 0 to {}", i, kind, id,
                         static_cast<std::int64_t>(mesh_.nodes.size()) - 1),
             "correct the id (VTK counts from 0), or add the missing points");
      }
      cell[k] = static_cast<Index>(id);
    }
    if (nodes > static_cast<std::int64_t>(count)) quadratic_.add(type.name);
    return cell;
  }

  VtkGrid grid_;
  const std::string& name_;
  TetMesh mesh_;
  ReadNotes& notes_;
  RefusedCells refused_;
  CornerCells quadratic_;
};

}  // namespace

TetMesh mesh_from_grid(VtkGrid grid, const std::string& name, ReadNotes& notes) {
  return GridReader(std::move(grid), name, notes).mesh();
}

std::vector<int> joined_cell_labels(const TetMesh& mesh) {
  if (mesh.tet_label.empty() && mesh.face_label.empty()) return {};
  std::vector<int> labels = mesh.tet_label;
  labels.resize(mesh.tets.size());
  labels.insert(labels.end(), mesh.face_label.begin(), mesh.face_label.end());
  labels.resize(mesh.tets.size() + mesh.faces.size());
  return labels;
}

}  // namespace sinew::io
