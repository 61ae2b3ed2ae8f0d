#include <fmt/format.h>

#include <bit>
#include <iterator>

#include "sinew/io/value_reader.h"
#include "sinew/io/vtk.h"
#include "sinew/io/vtk_grid.h"

namespace sinew::io {
namespace {

// Numbers as text or as big-endian bytes, with a line break behind each record or array.
class Writer {
 public:
  Writer(std::string& out, bool binary) : out_(out), binary_(binary) {}

  template <typename... Values>
  void line(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(out_), format, std::forward<Values>(values)...);
  }
  template <typename T>
  void value(T v) {
    if (binary_) {
      append_bytes(out_, v, std::endian::native == std::endian::little);
    } else {
      fmt::format_to(std::back_inserter(out_), "{} ", v);
    }
  }
  void end_record() {
    if (!binary_) out_.back() = '\n';
  }
  void end_array() {
    if (binary_) out_ += '\n';
  }
  template <typename Cell>
  void cell(const Cell& nodes) {
    value(static_cast<int>(nodes.size()));
    for (const Index node : nodes) value(node);
    end_record();
  }
  void integer(int v) {
    value(v);
    end_record();
  }

 private:
  std::string& out_;
  bool binary_;
};

}  // namespace

std::string format_vtk(const TetMesh& mesh, bool binary) {
  std::string text;
  Writer out(text, binary);
  out.line("# vtk DataFile Version 3.0\nmesh written by sinew\n{}\nDATASET UNSTRUCTURED_GRID\n",
           binary ? "BINARY" : "ASCII");
  out.line("POINTS {} double\n", mesh.nodes.size());
  for (const Vec3& x : mesh.nodes) {
    for (int k = 0; k < 3; ++k) out.value(x[k]);
    out.end_record();
  }
  out.end_array();
  const std::size_t cells = mesh.tets.size() + mesh.faces.size();
  out.line("CELLS {} {}\n", cells, 5 * mesh.tets.size() + 4 * mesh.faces.size());
  for (const Tet& t : mesh.tets) out.cell(t);
  for (const Triangle& f : mesh.faces) out.cell(f);
  out.end_array();
  out.line("CELL_TYPES {}\n", cells);
  for (std::size_t i = 0; i < cells; ++i) out.integer(i < mesh.tets.size() ? 10 : 5);
  out.end_array();
  if (const std::vector<int> labels = joined_cell_labels(mesh); !labels.empty()) {
    out.line("CELL_DATA {}\nSCALARS {} int 1\nLOOKUP_TABLE default\n", cells, cell_label_name);
    for (const int label : labels) out.integer(label);
    out.end_array();
  }
  if (!mesh.node_label.empty()) {
    out.line("POINT_DATA {}\nSCALARS {} int 1\nLOOKUP_TABLE default\n", mesh.nodes.size(),
             point_label_name);
    for (const int label : mesh.node_label) out.integer(label);
    out.end_array();
  }
  return text;
}

}  // namespace sinew::io
