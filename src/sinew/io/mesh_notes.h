// What a reader of meshes found besides the mesh: the arrays of the file, the one that the labels
// come from, and remarks for the user.
#pragma once

#include <string>
#include <vector>

namespace sinew::io {

// Names of the arrays that the labels come from; empty: the reader chooses (docs/meshes.md).
struct LabelNames {
  std::string tets;   // of tets and faces: a cell array, "gmsh:physical" or "gmsh:geometrical"
  std::string nodes;  // of nodes: a point array
};

enum class ArrayKind { whole, fractional, text, vector };

// "whole numbers", "numbers", "text", "vectors"
std::string name(ArrayKind kind);

struct MeshArray {
  std::string name;
  bool of_cells = true;               // otherwise of the points
  ArrayKind kind = ArrayKind::whole;  // fractional: a type of real numbers, if not looked at
  bool used = false;                  // its values are the labels
};

struct ReadNotes {
  std::string tet_labels;            // source of the labels of tets and faces; empty: none
  std::string node_labels;           // source of the labels of nodes; empty: none
  std::vector<MeshArray> arrays;     // of cells, then of points, in the file's order
  std::vector<std::string> remarks;  // sentences without a full stop
};

// The names of the unused cell arrays of whole numbers, quoted: "\"tissue\", \"part\"".
std::string unused_cell_arrays(const ReadNotes& notes);

}  // namespace sinew::io
