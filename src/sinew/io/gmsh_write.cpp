#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "sinew/io/gmsh.h"
#include "sinew/io/value_reader.h"

namespace sinew::io {
namespace {

constexpr int triangle_type = 2;
constexpr int tet_type = 4;

// Numbers as text with blanks, or as bytes.
class ValueWriter {
 public:
  ValueWriter(std::string& out, bool binary) : out_(out), binary_(binary) {}

  template <typename T>
  void value(T v) {
    if (binary_) {
      append_bytes(out_, v);
    } else {
      fmt::format_to(std::back_inserter(out_), "{} ", v);
    }
  }
  void integer(int v) { value(v); }
  void size(std::size_t v) { value(static_cast<std::uint64_t>(v)); }
  void position(const Vec3& x) {
    for (int k = 0; k < 3; ++k) value(x[k]);
  }
  void end_line() {
    if (!binary_) out_.back() = '\n';  // in place of the last blank
  }
  // A count on a line of its own, as text in both forms of 2.2.
  void text_line(std::size_t v) { fmt::format_to(std::back_inserter(out_), "{}\n", v); }
  void section(std::string_view name) { fmt::format_to(std::back_inserter(out_), "${}\n", name); }
  void end_section(std::string_view name) {
    fmt::format_to(std::back_inserter(out_), "{}$End{}\n", binary_ ? "\n" : "", name);
  }
  bool binary() const { return binary_; }

 private:
  std::string& out_;
  bool binary_;
};

int label_of(const std::vector<int>& labels, std::size_t i) {
  return labels.empty() ? 0 : labels[i];
}

// Physical groups have positive tags. A label that is not positive becomes the tag of an entity
// without group; entities of groups count from 1.
std::vector<int> distinct_labels(const std::vector<int>& labels, std::size_t cells) {
  if (cells == 0) return {};
  std::vector<int> distinct = labels.empty() ? std::vector<int>{0} : labels;
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  return distinct;
}

int entity_of(const std::vector<int>& distinct, int label) {
  if (label <= 0) return label;
  const auto place = std::lower_bound(distinct.begin(), distinct.end(), label);
  return static_cast<int>(place - distinct.begin()) + 1;
}

void write_header(ValueWriter& out, std::string& text, GmshVersion version) {
  out.section("MeshFormat");
  fmt::format_to(std::back_inserter(text), "{} {} 8\n",
                 version == GmshVersion::v4_1 ? "4.1" : "2.2", out.binary() ? 1 : 0);
  if (out.binary()) out.integer(1);
  out.end_section("MeshFormat");
}

template <typename Cell>
void write_elements22(ValueWriter& out, int type, const std::vector<Cell>& cells,
                      const std::vector<int>& labels, int first_id) {
  if (cells.empty()) return;
  const std::vector<int> distinct = distinct_labels(labels, cells.size());
  if (out.binary()) {
    for (const int v : {type, static_cast<int>(cells.size()), 2}) out.integer(v);
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const int label = label_of(labels, i);
    out.integer(first_id + static_cast<int>(i));
    if (!out.binary()) {
      out.integer(type);
      out.integer(2);
    }
    out.integer(std::max(label, 0));  // 0: in no group
    out.integer(entity_of(distinct, label));
    for (const Index node : cells[i]) out.integer(node + 1);
    out.end_line();
  }
}

void write22(const TetMesh& mesh, ValueWriter& out) {
  out.section("Nodes");
  out.text_line(mesh.nodes.size());
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    out.integer(static_cast<int>(i) + 1);
    out.position(mesh.nodes[i]);
    out.end_line();
  }
  out.end_section("Nodes");
  out.section("Elements");
  out.text_line(mesh.faces.size() + mesh.tets.size());
  write_elements22(out, triangle_type, mesh.faces, mesh.face_label, 1);
  write_elements22(out, tet_type, mesh.tets, mesh.tet_label,
                   1 + static_cast<int>(mesh.faces.size()));
  out.end_section("Elements");
}

// One entity for each label; no boundaries are listed.
void write_entities(ValueWriter& out, const TetMesh& mesh, const std::vector<int>& surfaces,
                    const std::vector<int>& volumes) {
  Vec3 low = Vec3::Zero();
  Vec3 high = Vec3::Zero();
  if (!mesh.nodes.empty()) low = high = mesh.nodes.front();
  for (const Vec3& x : mesh.nodes) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  out.section("Entities");
  for (const std::size_t n : {std::size_t{0}, std::size_t{0}, surfaces.size(), volumes.size()}) {
    out.size(n);
  }
  out.end_line();
  for (const std::vector<int>* labels : {&surfaces, &volumes}) {
    for (const int label : *labels) {
      out.integer(entity_of(*labels, label));
      out.position(low);
      out.position(high);
      out.size(label > 0 ? 1 : 0);
      if (label > 0) out.integer(label);
      out.size(0);  // boundaries
      out.end_line();
    }
  }
  out.end_section("Entities");
}

// The start of each run of cells with one label; the last entry is the end of all.
std::vector<std::size_t> label_runs(const std::vector<int>& labels, std::size_t cells) {
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < cells; ++i) {
    if (i == 0 || label_of(labels, i) != label_of(labels, i - 1)) starts.push_back(i);
  }
  starts.push_back(cells);
  return starts;
}

// A block for each run of equal labels: an entity may have several, and the cells keep their order.
template <typename Cell>
void write_blocks41(ValueWriter& out, int type, const std::vector<Cell>& cells,
                    const std::vector<int>& labels, const std::vector<int>& distinct,
                    const std::vector<std::size_t>& runs, std::size_t first_id) {
  for (std::size_t r = 0; r + 1 < runs.size(); ++r) {
    out.integer(type == tet_type ? 3 : 2);
    out.integer(entity_of(distinct, label_of(labels, runs[r])));
    out.integer(type);
    out.size(runs[r + 1] - runs[r]);
    out.end_line();
    for (std::size_t i = runs[r]; i < runs[r + 1]; ++i) {
      out.size(first_id + i);
      for (const Index node : cells[i]) out.size(static_cast<std::size_t>(node) + 1);
      out.end_line();
    }
  }
}

void write41(const TetMesh& mesh, ValueWriter& out) {
  const std::vector<int> surfaces = distinct_labels(mesh.face_label, mesh.faces.size());
  const std::vector<int> volumes = distinct_labels(mesh.tet_label, mesh.tets.size());
  write_entities(out, mesh, surfaces, volumes);

  const std::size_t nodes = mesh.nodes.size();
  out.section("Nodes");
  for (const std::size_t v : {std::size_t{1}, nodes, std::size_t{1}, nodes}) out.size(v);
  out.end_line();
  // All in the first volume, without parameters.
  for (const int v : {3, volumes.empty() ? 1 : entity_of(volumes, volumes.front()), 0}) {
    out.integer(v);
  }
  out.size(nodes);
  out.end_line();
  for (std::size_t i = 0; i < nodes; ++i) {
    out.size(i + 1);
    out.end_line();
  }
  for (const Vec3& x : mesh.nodes) {
    out.position(x);
    out.end_line();
  }
  out.end_section("Nodes");

  const std::vector<std::size_t> face_runs = label_runs(mesh.face_label, mesh.faces.size());
  const std::vector<std::size_t> tet_runs = label_runs(mesh.tet_label, mesh.tets.size());
  const std::size_t cells = mesh.faces.size() + mesh.tets.size();
  out.section("Elements");
  for (const std::size_t v :
       {face_runs.size() + tet_runs.size() - 2, cells, std::size_t{1}, cells}) {
    out.size(v);
  }
  out.end_line();
  write_blocks41(out, triangle_type, mesh.faces, mesh.face_label, surfaces, face_runs, 1);
  write_blocks41(out, tet_type, mesh.tets, mesh.tet_label, volumes, tet_runs,
                 1 + mesh.faces.size());
  out.end_section("Elements");
}

}  // namespace

std::string format_gmsh(const TetMesh& mesh, GmshVersion version, bool binary) {
  std::string text;
  ValueWriter out(text, binary);
  write_header(out, text, version);
  if (version == GmshVersion::v4_1) {
    write41(mesh, out);
  } else {
    write22(mesh, out);
  }
  return text;
}

}  // namespace sinew::io
