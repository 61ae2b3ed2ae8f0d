// Shared by the two versions of the Gmsh format. For gmsh*.cpp only.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sinew/io/cells.h"
#include "sinew/io/value_reader.h"

namespace sinew::io {

// Maps the node ids of a file, which may have gaps and any order, to indices.
class NodeIds {
 public:
  void reserve(std::size_t count) { ids_.reserve(count); }
  void add(std::int64_t id) { ids_.push_back(id); }
  std::size_t size() const { return ids_.size(); }
  // Call once when all are added. Returns the first duplicate id, or -1.
  std::int64_t finish();
  Index find(std::int64_t id) const;  // -1: no such node
  std::int64_t lowest() const;
  std::int64_t highest() const;

 private:
  std::vector<std::int64_t> ids_;                       // in the file's order
  std::vector<std::pair<std::int64_t, Index>> sorted_;  // empty if the ids have no gaps
};

// A .msh file after its header: its sections, its numbers, and the mesh read so far.
struct GmshFile {
  explicit GmshFile(TextReader& reader) : text(reader), values(reader) {}

  TextReader& text;
  ValueReader values;
  int size_bytes = 8;  // of a size_t in binary 4.1
  NodeIds ids;
  bool has_nodes = false;
  TetMesh mesh;
  RefusedCells refused;

  std::int64_t size(const Wanted& wanted);  // a size_t
  void expect_end(std::string_view section);
  void start_nodes();     // Error at a second $Nodes
  void finish_nodes();    // Error if two nodes have one id
  void start_elements();  // Error if the nodes are still missing
  CellType cell_type(int type, const Wanted& wanted);
  // Reads the nodes of one element and keeps it if it is a tet or a face.
  template <typename ReadId>
  void element(const CellType& type, std::int64_t id, int label, ReadId read_id);
  Index node(std::int64_t id, std::string_view kind, std::int64_t element);
};

// The sections $Nodes, $Elements (and $Entities) of each version; false for other sections.
bool read_gmsh22_section(GmshFile& file, std::string_view section);

class Gmsh41Sections {
 public:
  bool read(GmshFile& file, std::string_view section);

 private:
  void entities(GmshFile& file);
  void nodes(GmshFile& file);
  void elements(GmshFile& file);

  std::map<std::pair<int, int>, int> physical_;  // (dimension, entity tag) -> physical tag
};

template <typename ReadId>
void GmshFile::element(const CellType& type, std::int64_t id, int label, ReadId read_id) {
  if (type.use == CellUse::tet) {
    Tet tet{};
    for (Index& corner : tet) corner = node(read_id(), "tetrahedron", id);
    mesh.tets.push_back(tet);
    mesh.tet_label.push_back(label);
  } else if (type.use == CellUse::face) {
    Triangle face{};
    for (Index& corner : face) corner = node(read_id(), "triangle", id);
    mesh.faces.push_back(face);
    mesh.face_label.push_back(label);
  } else {
    for (int i = 0; i < type.nodes; ++i) read_id();
    if (type.use == CellUse::refuse) refused.add(type.name);
  }
}

}  // namespace sinew::io
