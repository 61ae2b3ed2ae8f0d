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

// The tags of a cell. 0: none.
struct GmshTags {
  int physical = 0;
  int entity = 0;
};

// The choice of the labels, and what it found.
class GmshLabels {
 public:
  // Error (input) for another name than gmsh:physical and gmsh:geometrical.
  GmshLabels(const LabelNames& asked, const std::string& file);
  int label(GmshTags tags);
  void describe(ReadNotes& notes) const;

 private:
  enum class Source { both, physical, entity };
  Source source_ = Source::both;
  bool grouped_ = false, ungrouped_ = false;  // some cells are in a group, some in none
};

// A .msh file after its header: its sections, its numbers, and the mesh read so far.
struct GmshFile {
  GmshFile(TextReader& reader, const LabelNames& asked, ReadNotes& file_notes)
      : text(reader), values(reader), labels(asked, reader.file()), notes(file_notes) {}

  TextReader& text;
  ValueReader values;
  int size_bytes = 8;  // of a size_t in binary 4.1
  NodeIds ids;
  bool has_nodes = false;
  TetMesh mesh;
  RefusedCells refused;
  CornerCells quadratic;
  GmshLabels labels;
  ReadNotes& notes;
  std::vector<int> tet_group;  // physical tag (tets)

  std::int64_t size(const Wanted& wanted);  // a size_t
  void expect_end(std::string_view section);
  void start_nodes();     // Error at a second $Nodes
  void finish_nodes();    // Error if two nodes have one id
  void start_elements();  // Error if the nodes are still missing
  CellType cell_type(int type, const Wanted& wanted);
  // Reads the nodes of one element and keeps it if it is a tet or a face.
  template <typename ReadId>
  void element(const CellType& type, std::int64_t id, GmshTags tags, ReadId read_id);
  Index node(std::int64_t id, std::string_view kind, std::int64_t element);
  // Gmsh 2 lists a tet once for each of its groups: the first stays. (Faces keep all labels: the
  // two sides of an interface may have different ones.)
  void merge_groups();
};

// The sections $Nodes, $Elements (and $Entities) of each version; false for other sections.
bool read_gmsh22_section(GmshFile& file, std::string_view section);

class Gmsh41Sections {
 public:
  bool read(GmshFile& file, std::string_view section);
  // Says which entities are in several groups.
  void remark(ReadNotes& notes) const;

 private:
  void entities(GmshFile& file, bool partitioned);
  void nodes(GmshFile& file);
  void elements(GmshFile& file);

  struct Entity {
    GmshTags tags;  // of an entity of a partitioned mesh: those of its parent
    int groups = 0;
  };
  void parent(GmshFile& file, std::string_view kind, int dimension, int tag, Entity& entity);
  void physical_tags(GmshFile& file, std::string_view kind, int tag, Entity& entity);

  std::map<std::pair<int, int>, Entity> entities_;  // by dimension and tag
};

template <typename ReadId>
void GmshFile::element(const CellType& type, std::int64_t id, GmshTags tags, ReadId read_id) {
  int left = type.nodes;  // after the corners

  if (type.use == CellUse::tet) {
    Tet tet{};
    for (Index& corner : tet) corner = node(read_id(), "tetrahedron", id);
    mesh.tets.push_back(tet);
    mesh.tet_label.push_back(labels.label(tags));
    tet_group.push_back(tags.physical);
    left -= 4;
  } else if (type.use == CellUse::face) {
    Triangle face{};
    for (Index& corner : face) corner = node(read_id(), "triangle", id);
    mesh.faces.push_back(face);
    mesh.face_label.push_back(labels.label(tags));
    left -= 3;
  } else if (type.use == CellUse::refuse) {
    refused.add(type.name);
  }
  if (left > 0 && (type.use == CellUse::tet || type.use == CellUse::face)) quadratic.add(type.name);
  for (; left > 0; --left) read_id();
}

}  // namespace sinew::io
