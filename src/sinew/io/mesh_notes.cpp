#include "sinew/io/mesh_notes.h"

namespace sinew::io {

std::string name(ArrayKind kind) {
  switch (kind) {
    case ArrayKind::whole:
      return "whole numbers";
    case ArrayKind::fractional:
      return "numbers";
    case ArrayKind::text:
      return "text";
    case ArrayKind::vector:
      return "vectors";
  }
  return {};
}

std::string unused_cell_arrays(const ReadNotes& notes) {
  std::string list;
  for (const MeshArray& array : notes.arrays) {
    if (!array.of_cells || array.used || array.kind != ArrayKind::whole) continue;
    list += (list.empty() ? "\"" : ", \"") + array.name + '"';
  }
  return list;
}

}  // namespace sinew::io
