#include "sinew/io/medit.h"

#include <fmt/format.h>

#include <array>
#include <iterator>
#include <optional>
#include <vector>

#include "sinew/base/text.h"
#include "sinew/io/cells.h"
#include "sinew/io/text_reader.h"

namespace sinew::io {
namespace {

// A section that is counted and skipped: the values of an entry. refused: plural name of cells that
// are not allowed.
struct Skipped {
  std::string_view keyword;
  std::size_t values;
  std::string_view refused = {};
};
constexpr std::array skipped_sections = {
    Skipped{"Edges", 3},
    Skipped{"Corners", 1},
    Skipped{"Ridges", 1},
    Skipped{"Quadrilaterals", 5},
    Skipped{"Hexahedra", 9, "hexahedra"},
    Skipped{"Prisms", 7, "prisms"},
    Skipped{"Pyramids", 6, "pyramids"},
    Skipped{"TrianglesP2", 7, "quadratic triangles"},
    Skipped{"TetrahedraP2", 11, "quadratic tetrahedra"},
    Skipped{"EdgesP2", 4},
    Skipped{"RequiredVertices", 1},
    Skipped{"RequiredEdges", 1},
    Skipped{"RequiredTriangles", 1},
    Skipped{"RequiredQuadrilaterals", 1},
    Skipped{"RequiredTetrahedra", 1},
    Skipped{"Normals", 3},
    Skipped{"NormalAtVertices", 2},
    Skipped{"NormalAtTriangleVertices", 3},
    Skipped{"NormalAtQuadrilateralVertices", 3},
    Skipped{"Tangents", 3},
    Skipped{"TangentAtVertices", 2},
    Skipped{"TangentAtEdges", 3},
    Skipped{"VertexOnGeometricVertex", 2},
    Skipped{"VertexOnGeometricEdge", 3},
    Skipped{"EdgeOnGeometricEdge", 2},
};

std::vector<std::string_view> all_keywords() {
  std::vector<std::string_view> keywords = {"Vertices", "Triangles", "Tetrahedra",
                                            "End",      "Dimension", "AngleOfCornerBound"};
  for (const Skipped& section : skipped_sections) keywords.push_back(section.keyword);
  return keywords;
}

// One parse. Triangles and tetrahedra before the vertices are skipped first and read when the
// number of vertices is known, so that a bad id is reported at its own line.
class MeditParser {
 public:
  MeditParser(std::string_view text, const std::string& name) : reader_(text, name, '#') {}

  TetMesh parse();

 private:
  void header();
  void section();
  void section_without_geometry(std::string_view keyword);
  void once(bool& seen, std::string_view keyword);
  void dimension();
  void vertices();
  template <std::size_t corners>
  void cells(TextReader& reader, std::string_view kind, std::size_t count,
             std::vector<std::array<Index, corners>>& cells, std::vector<int>& labels);
  void triangles(TextReader& reader) {
    const std::size_t count = reader.count({"the number of Triangles"}, 4);
    reader.set_part("a line of Triangles", "vertex vertex vertex label");
    cells(reader, "triangle", count, mesh_.faces, mesh_.face_label);
  }
  void tetrahedra(TextReader& reader) {
    const std::size_t count = reader.count({"the number of Tetrahedra"}, 5);
    reader.set_part("a line of Tetrahedra", "vertex vertex vertex vertex label");
    cells(reader, "tetrahedron", count, mesh_.tets, mesh_.tet_label);
  }
  // Reads the section now, or stores its place and skips it.
  void now_or_later(std::optional<TextReader>& later, void (MeditParser::*read)(TextReader&),
                    std::size_t values, std::string_view what);

  TextReader reader_;
  TetMesh mesh_;
  RefusedCells refused_;
  std::string_view section_ = "MeshVersionFormatted";  // the last keyword
  bool has_dimension_ = false;
  bool has_vertices_ = false;
  bool has_triangles_ = false;
  bool has_tetrahedra_ = false;
  std::optional<TextReader> later_triangles_;
  std::optional<TextReader> later_tetrahedra_;
};

TetMesh MeditParser::parse() {
  header();
  while (!reader_.at_end() && reader_.peek() != "End") section();
  if (!has_vertices_) {
    reader_.fail_file("has no section Vertices",
                      "a MEDIT mesh lists Vertices, then Tetrahedra: export it again");
  }
  if (later_triangles_) triangles(*later_triangles_);
  if (later_tetrahedra_) tetrahedra(*later_tetrahedra_);
  refused_.check(reader_.file());
  require_tets(mesh_, reader_.file());
  drop_zero_labels(mesh_.node_label);
  return std::move(mesh_);
}

void MeditParser::header() {
  constexpr std::string_view remedy =
      "a MEDIT mesh starts with \"MeshVersionFormatted 2\" and \"Dimension 3\"; the binary form "
      "(.meshb) must be converted to text first";
  const std::string_view first = reader_.word({"MeshVersionFormatted"});
  if (first != "MeshVersionFormatted") {
    reader_.fail(fmt::format("expected MeshVersionFormatted, found {}", quoted(first)),
                 std::string(remedy));
  }
  constexpr Wanted version{"the version after MeshVersionFormatted"};
  const std::int64_t found = reader_.integer(version);
  if (found < 1 || found > 4) {
    reader_.fail(fmt::format("MeshVersionFormatted is {}; versions 1 to 4 can be read", found),
                 "export the mesh as version 2");
  }
}

void MeditParser::section() {
  const std::string_view before = section_;
  const std::string_view keyword = section_ = reader_.word({"a section"});
  reader_.set_part({}, {});
  if (keyword.find_first_of("0123456789") == 0 || keyword.find_first_of("-+.") == 0) {
    reader_.fail(
        fmt::format("expected a section, found {}", quoted(keyword)),
        fmt::format("the count of {} is too small, or one of its lines has too many values",
                    before));
  }
  if (keyword == "Dimension") {
    dimension();
  } else if (!has_dimension_) {
    reader_.fail(fmt::format("expected Dimension 3, found {}", quoted(keyword)),
                 "put \"Dimension 3\" after MeshVersionFormatted");
  } else if (keyword == "Vertices") {
    once(has_vertices_, keyword);
    vertices();
  } else if (keyword == "Triangles") {
    once(has_triangles_, keyword);
    now_or_later(later_triangles_, &MeditParser::triangles, 4, "the number of Triangles");
  } else if (keyword == "Tetrahedra") {
    once(has_tetrahedra_, keyword);
    now_or_later(later_tetrahedra_, &MeditParser::tetrahedra, 5, "the number of Tetrahedra");
  } else {
    section_without_geometry(keyword);
  }
}

void MeditParser::section_without_geometry(std::string_view keyword) {
  if (keyword == "AngleOfCornerBound") {  // a setting, one value
    reader_.real({"the angle of AngleOfCornerBound"});
    return;
  }
  for (const Skipped& section : skipped_sections) {
    if (keyword != section.keyword) continue;
    const std::size_t count =
        reader_.count({"the number of entries", section.keyword}, section.values);
    if (count > 0 && !section.refused.empty()) refused_.add(section.refused, count);
    reader_.skip_values(count * section.values, {"a value", section.keyword});
    return;
  }
  const std::string meant = nearest(keyword, all_keywords());
  reader_.fail(fmt::format("expected a section, found {}", quoted(keyword)),
               meant.empty()
                   ? std::string("remove this section: only those of the MEDIT format can "
                                 "be read")
                   : fmt::format("did you mean {}?", meant));
}

void MeditParser::once(bool& seen, std::string_view keyword) {
  if (seen) {
    reader_.fail(fmt::format("a second section {}", keyword), "join the two sections into one");
  }
  seen = true;
}

void MeditParser::dimension() {
  const std::int64_t found = reader_.integer({"the number after Dimension"});
  if (found != 3) {
    reader_.fail(fmt::format("Dimension is {}, 3 was expected", found),
                 "export a volume mesh: a tetrahedral mesh has three coordinates a vertex");
  }
  has_dimension_ = true;
}

void MeditParser::vertices() {
  const std::size_t count = reader_.count({"the number of Vertices"}, 4);
  reader_.set_part("a line of Vertices", "x y z label");
  require_indexable(count, "vertices", reader_.file());
  mesh_.nodes.reserve(count);
  mesh_.node_label.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto number = static_cast<std::int64_t>(i + 1);
    const double x = reader_.real({"x", "vertex", number});
    const double y = reader_.real({"y", "vertex", number});
    const double z = reader_.real({"z", "vertex", number});
    mesh_.nodes.emplace_back(x, y, z);
    mesh_.node_label.push_back(reader_.label({"label", "vertex", number}));
  }
}

template <std::size_t corners>
void MeditParser::cells(TextReader& reader, std::string_view kind, std::size_t count,
                        std::vector<std::array<Index, corners>>& cells, std::vector<int>& labels) {
  require_indexable(count, "cells", reader.file());
  const std::int64_t last = mesh_.node_count();
  cells.reserve(count);
  labels.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto number = static_cast<std::int64_t>(i + 1);
    std::array<Index, corners> cell{};
    for (Index& corner : cell) {
      const std::int64_t id = reader.integer({"a vertex", kind, number});
      if (id < 1 || id > last) {
        reader.fail(fmt::format("{} {} names vertex {}; the file has vertices 1 to {}", kind,
                                number, id, last),
                    "correct the id (MEDIT counts from 1), or add the missing vertices");
      }
      corner = static_cast<Index>(id - 1);
    }
    cells.push_back(cell);
    labels.push_back(reader.label({"label", kind, number}));
  }
}

void MeditParser::now_or_later(std::optional<TextReader>& later,
                               void (MeditParser::*read)(TextReader&), std::size_t values,
                               std::string_view what) {
  if (has_vertices_) {
    (this->*read)(reader_);
    return;
  }
  later = reader_;
  const std::size_t count = reader_.count({what}, values);
  reader_.skip_values(count * values, {"a value", "the section"});
}

}  // namespace

TetMesh parse_medit(std::string_view text, const std::string& name) {
  return MeditParser(text, name).parse();
}

std::string format_medit(const TetMesh& mesh) {
  std::string text = "MeshVersionFormatted 2\nDimension 3\n";
  auto out = std::back_inserter(text);
  fmt::format_to(out, "Vertices\n{}\n", mesh.nodes.size());
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const Vec3& x = mesh.nodes[i];
    fmt::format_to(out, "{} {} {} {}\n", x[0], x[1], x[2],
                   mesh.node_label.empty() ? 0 : mesh.node_label[i]);
  }
  if (!mesh.faces.empty()) fmt::format_to(out, "Triangles\n{}\n", mesh.faces.size());
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const Triangle& f = mesh.faces[i];
    fmt::format_to(out, "{} {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1,
                   mesh.face_label.empty() ? 0 : mesh.face_label[i]);
  }
  fmt::format_to(out, "Tetrahedra\n{}\n", mesh.tets.size());
  for (std::size_t i = 0; i < mesh.tets.size(); ++i) {
    const Tet& t = mesh.tets[i];
    fmt::format_to(out, "{} {} {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1, t[3] + 1,
                   mesh.tet_label.empty() ? 0 : mesh.tet_label[i]);
  }
  text += "End\n";
  return text;
}

}  // namespace sinew::io
