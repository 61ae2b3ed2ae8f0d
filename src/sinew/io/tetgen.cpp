#include "sinew/io/tetgen.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "sinew/io/cells.h"
#include "sinew/io/text_reader.h"

namespace sinew::io {
namespace {

constexpr std::int64_t most_attributes = 1000;

// One of the files. Its records are lines. The number of values on each line is checked, because a
// header with a wrong number of columns would otherwise shift every number.
class LineFile {
 public:
  LineFile(std::string_view text, const std::string& name, std::string_view kind)
      : reader_(text, name, '#'), kind_(kind) {}

  TextReader& reader() { return reader_; }
  void set_record(std::int64_t number) { number_ = number; }
  Wanted wanted(std::string_view value) const { return {value, kind_, number_}; }

  double real(std::string_view value) {
    check_line(value);
    return reader_.real(wanted(value));
  }
  std::int64_t integer(std::string_view value) {
    check_line(value);
    return reader_.integer(wanted(value));
  }
  int label(std::string_view value) {
    check_line(value);
    return reader_.label(wanted(value));
  }
  // Ids count up from 0 or 1; base is -1 until the first is seen.
  void id(std::int64_t& base, std::int64_t position) {
    const std::int64_t found = reader_.integer(wanted("id"));
    if (base < 0 && (found == 0 || found == 1)) base = found;
    if (base >= 0 && found == base + position) return;
    reader_.fail(
        base < 0 ? fmt::format("the first {} has the id {}; 0 or 1 was expected", kind_, found)
                 : fmt::format("expected the {} with the id {}, found {}", kind_, base + position,
                               found),
        "TetGen counts from 0 or 1 without gaps: renumber the file, or correct the counts in its "
        "first line");
  }
  void end_record() {
    if (reader_.at_line_end()) return;
    const std::string_view extra = reader_.word({"the end of the line"});
    reader_.fail(fmt::format("{} {} has more values than the first line of the file says: {}",
                             kind_, number_, quoted(extra)),
                 "correct the numbers of attributes and markers in the first line, or remove the "
                 "extra values");
  }

 private:
  void check_line(std::string_view value) {
    if (!reader_.at_line_end() || reader_.at_end()) return;
    // The end of the line, not of the file: point at the next value.
    const std::string_view next = reader_.word(wanted(value));
    reader_.fail(fmt::format("the line of {} {} ends before {}; the next line starts with {}",
                             kind_, number_, value, quoted(next)),
                 "correct the numbers of attributes and markers in the first line, or restore the "
                 "missing values");
  }

  TextReader reader_;
  std::string_view kind_;
  std::int64_t number_ = 0;
};

std::int64_t optional_count(LineFile& file, std::string_view value, std::int64_t most) {
  if (file.reader().at_line_end()) return 0;
  return file.reader().integer({value}, 0, most);
}

// The last attribute is the region, a whole number that TetGen writes as a double. An attribute
// with fractions is something else: the tets have no labels then.
class Regions {
 public:
  void read(LineFile& file, std::vector<int>& labels) {
    const double found = file.real("the region");
    const bool whole = found == std::floor(found) && found >= std::numeric_limits<int>::min() &&
                       found <= std::numeric_limits<int>::max();
    if (!whole && !fraction_) fraction_ = found;
    labels.push_back(whole ? static_cast<int>(found) : 0);
  }
  void finish(std::vector<int>& labels, ReadNotes& notes) const {
    if (fraction_) {
      labels.clear();
      notes.remarks.push_back(fmt::format(
          "the last attribute of the tets is no label: it holds {}, and labels are whole numbers",
          *fraction_));
    } else if (!labels.empty()) {
      notes.tet_labels = "the last attribute of the .ele file";
    }
  }

 private:
  std::optional<double> fraction_;  // the first value that is none
};

// First line: count, dimension, attributes, markers (0 or 1). Returns the base of the ids.
std::int64_t read_nodes(const TetgenText& files, TetMesh& mesh) {
  LineFile file(files.node, files.node_name, "node");
  TextReader& reader = file.reader();
  const std::size_t count = reader.count({"the number of nodes"}, 4);
  require_indexable(count, "nodes", files.node_name);
  if (count == 0) {
    reader.fail(
        "the number of nodes is 0",
        "a .node file without nodes belongs to a .poly or .smesh file: name TetGen's output "
        "(NAME.1.node)");
  }
  const std::int64_t dimension = reader.at_line_end() ? 3 : reader.integer({"the dimension"});
  if (dimension != 3) {
    reader.fail(fmt::format("the dimension is {}, 3 was expected", dimension),
                "this is a file of Triangle, not of TetGen: make a volume mesh");
  }
  const std::int64_t attributes = optional_count(file, "the number of attributes", most_attributes);
  const std::int64_t markers = optional_count(file, "the number of boundary markers", 1);
  file.end_record();
  reader.set_part("a line of a .node file", "id x y z attributes... marker");
  mesh.nodes.reserve(count);
  std::int64_t base = -1;
  for (std::size_t i = 0; i < count; ++i) {
    file.set_record(static_cast<std::int64_t>(i));
    file.id(base, static_cast<std::int64_t>(i));
    file.set_record(static_cast<std::int64_t>(i) + base);
    const double x = file.real("x");
    const double y = file.real("y");
    const double z = file.real("z");
    mesh.nodes.emplace_back(x, y, z);
    for (std::int64_t k = 0; k < attributes; ++k) file.real("an attribute");
    if (markers > 0) mesh.node_label.push_back(file.label("marker"));
    file.end_record();
  }
  return base;
}

template <std::size_t corners>
std::array<Index, corners> read_corners(LineFile& file, std::string_view kind, std::int64_t number,
                                        std::int64_t base, const TetMesh& mesh) {
  std::array<Index, corners> cell{};
  const std::int64_t last = base + mesh.node_count() - 1;
  for (Index& corner : cell) {
    const std::int64_t id = file.integer("a node");
    if (id < base || id > last) {
      file.reader().fail(fmt::format("{} {} names node {}; the .node file has nodes {} to {}", kind,
                                     number, id, base, last),
                         fmt::format("correct the id (the .node file counts from {}), or take the "
                                     ".node file of the same run",
                                     base));
    }
    corner = static_cast<Index>(id - base);
  }
  return cell;
}

// First line: count, nodes a tet (10: quadratic, corners first), attributes.
void read_tets(const TetgenText& files, std::int64_t base, TetMesh& mesh, ReadNotes& notes) {
  LineFile file(files.ele, files.ele_name, "tetrahedron");
  TextReader& reader = file.reader();
  const std::size_t count = reader.count({"the number of tetrahedra"}, 5);
  require_indexable(count, "tetrahedra", files.ele_name);
  const std::int64_t corners =
      reader.at_line_end() ? 4 : reader.integer({"the number of nodes a tetrahedron"});
  if (corners != 4 && corners != 10) {
    reader.fail(fmt::format("the number of nodes a tetrahedron is {}, 4 was expected", corners),
                corners == 3 ? "this is a file of Triangle, not of TetGen: make a volume mesh"
                             : "correct the first line: count, 4, number of attributes");
  }
  const std::int64_t attributes = optional_count(file, "the number of attributes", most_attributes);
  file.end_record();
  reader.set_part("a line of a .ele file", "id node node node node attributes...");
  mesh.tets.reserve(count);
  Regions regions;
  std::int64_t first = base;
  for (std::size_t i = 0; i < count; ++i) {
    const std::int64_t number = base + static_cast<std::int64_t>(i);
    file.set_record(number);
    file.id(first, static_cast<std::int64_t>(i));
    mesh.tets.push_back(read_corners<4>(file, "tetrahedron", number, base, mesh));
    for (std::int64_t k = 4; k < corners; ++k) file.integer("a node");
    for (std::int64_t k = 1; k < attributes; ++k) file.real("an attribute");
    if (attributes > 0) regions.read(file, mesh.tet_label);
    file.end_record();
  }
  regions.finish(mesh.tet_label, notes);
  CornerCells quadratic;
  for (std::size_t i = 0; corners == 10 && i < count; ++i) quadratic.add("quadratic tetrahedra");
  quadratic.remark(notes);
}

// First line: count, markers. Values after the marker (TetGen -nn: the neighbours) are not needed.
void read_faces(const TetgenText& files, std::int64_t base, TetMesh& mesh) {
  LineFile file(files.face, files.face_name, "face");
  TextReader& reader = file.reader();
  const std::size_t count = reader.count({"the number of faces"}, 4);
  require_indexable(count, "faces", files.face_name);
  const std::int64_t markers = optional_count(file, "the number of boundary markers", 1);
  file.end_record();
  reader.set_part("a line of a .face file", "id node node node marker");
  mesh.faces.reserve(count);
  std::int64_t first = base;
  for (std::size_t i = 0; i < count; ++i) {
    const std::int64_t number = base + static_cast<std::int64_t>(i);
    file.set_record(number);
    file.id(first, static_cast<std::int64_t>(i));
    mesh.faces.push_back(read_corners<3>(file, "face", number, base, mesh));
    mesh.face_label.push_back(markers > 0 ? file.label("marker") : 0);
    reader.line_rest();
  }
}

}  // namespace

TetMesh parse_tetgen(const TetgenText& files, ReadNotes* notes) {
  TetMesh mesh;
  ReadNotes unread;
  const std::int64_t base = read_nodes(files, mesh);
  read_tets(files, base, mesh, notes == nullptr ? unread : *notes);
  if (!files.face.empty()) read_faces(files, base, mesh);
  require_tets(mesh, files.ele_name);
  drop_zero_labels(mesh.node_label);
  return mesh;
}

TetgenText format_tetgen(const TetMesh& mesh) {
  TetgenText files;
  auto out = std::back_inserter(files.node);
  const bool markers = !mesh.node_label.empty();
  fmt::format_to(out, "{} 3 0 {}\n", mesh.nodes.size(), markers ? 1 : 0);
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const Vec3& x = mesh.nodes[i];
    fmt::format_to(out, "{} {} {} {}", i + 1, x[0], x[1], x[2]);
    if (markers) fmt::format_to(out, " {}", mesh.node_label[i]);
    files.node += '\n';
  }
  out = std::back_inserter(files.ele);
  const bool regions = !mesh.tet_label.empty();
  fmt::format_to(out, "{} 4 {}\n", mesh.tets.size(), regions ? 1 : 0);
  for (std::size_t i = 0; i < mesh.tets.size(); ++i) {
    const Tet& t = mesh.tets[i];
    fmt::format_to(out, "{} {} {} {} {}", i + 1, t[0] + 1, t[1] + 1, t[2] + 1, t[3] + 1);
    if (regions) fmt::format_to(out, " {}", mesh.tet_label[i]);
    files.ele += '\n';
  }
  if (mesh.faces.empty()) return files;
  out = std::back_inserter(files.face);
  fmt::format_to(out, "{} 1\n", mesh.faces.size());
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const Triangle& f = mesh.faces[i];
    fmt::format_to(out, "{} {} {} {} {}\n", i + 1, f[0] + 1, f[1] + 1, f[2] + 1,
                   mesh.face_label.empty() ? 0 : mesh.face_label[i]);
  }
  return files;
}

}  // namespace sinew::io
