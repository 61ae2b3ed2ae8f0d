#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <utility>

#include "sinew/base/text.h"
#include "sinew/io/cells.h"
#include "sinew/io/vtk.h"
#include "sinew/io/vtk_grid.h"
#include "sinew/io/vtk_values.h"

namespace sinew::io {
namespace {

class VtkParser {
 public:
  VtkParser(std::string_view bytes, const std::string& name, const LabelNames& asked,
            ReadNotes& notes)
      : text_(bytes, name, 0), values_(text_), notes_(notes), grid_(asked) {}

  TetMesh parse();

 private:
  enum class Owner { grid, points, cells };

  void header();
  void section(std::string_view keyword);
  void points();
  void cells();
  void cells_with_sizes(std::size_t count, std::size_t size);
  void cells_with_offsets(std::size_t offsets, std::size_t size);
  void cell_types();
  void start_attributes(Owner owner);
  bool attribute(std::string_view keyword);
  void scalars();
  void field();
  void metadata();

  // The type of an array and its tuples x components values; stored if they may be labels.
  void array(std::string name, std::size_t components, std::size_t tuples);
  void array(std::string name, std::size_t components, std::size_t tuples, Scalar type);
  std::int64_t point_id(Scalar type, std::size_t cell);

  TextReader text_;
  VtkValues values_;
  bool has_offsets_ = false;  // version 5: cells as offsets and connectivity
  bool has_points_ = false;
  bool has_cells_ = false;
  bool has_types_ = false;
  Owner owner_ = Owner::grid;
  std::size_t tuples_ = 0;  // values an array of the present owner has
  ReadNotes& notes_;
  VtkGrid grid_;
};

TetMesh VtkParser::parse() {
  header();
  while (!text_.at_end()) {
    const std::string_view keyword = text_.word({"a section"});
    text_.set_part({}, {});
    section(keyword);
  }
  if (!has_points_ || !has_cells_ || !has_types_) {
    text_.fail_file(fmt::format("has no section {}", !has_points_  ? "POINTS"
                                                     : !has_cells_ ? "CELLS"
                                                                   : "CELL_TYPES"),
                    "the file was cut short, or is no unstructured grid: export it again");
  }
  return mesh_from_grid(std::move(grid_), text_.file(), notes_);
}

void VtkParser::header() {
  const std::string_view first = text_.line_rest();
  constexpr std::string_view magic = "# vtk DataFile Version ";
  if (!first.starts_with(magic)) {
    text_.fail(fmt::format("expected \"{}X.Y\" in line 1, found {}", magic, quoted(first)),
               "is this a legacy VTK file? The XML form has the ending .vtu");
  }
  const std::string_view version = first.substr(magic.size());
  if (version.empty() || version[0] < '1' || version[0] > '5' ||
      (version.size() > 1 && version[1] != '.')) {
    text_.fail(fmt::format("the version is {}; 1.0 to 5.1 can be read", quoted(version)),
               "save it again as a VTU file (in ParaView: Save Data)");
  }
  has_offsets_ = version[0] == '5';
  text_.line_rest();  // the title
  const std::string_view form = text_.word({"ASCII or BINARY"});
  const bool binary = same_word(form, "BINARY");
  if (!binary && !same_word(form, "ASCII")) {
    text_.fail(fmt::format("expected ASCII or BINARY, found {}", quoted(form)),
               "line 3 of a VTK file says the form of its numbers, line 2 is a title");
  }
  values_.set_form(binary);
  const std::string_view dataset = text_.word({"DATASET"});
  if (!same_word(dataset, "DATASET")) {
    text_.fail(fmt::format("expected DATASET, found {}", quoted(dataset)),
               "line 4 of a VTK file is \"DATASET UNSTRUCTURED_GRID\"");
  }
  const std::string_view kind = text_.word({"the kind of data set"});
  if (!same_word(kind, "UNSTRUCTURED_GRID")) {
    const bool image = same_word(kind, "STRUCTURED_POINTS");
    text_.fail(fmt::format("the data set is {}, {}UNSTRUCTURED_GRID was expected", quoted(kind),
                           same_word(kind, "POLYDATA") ? "a surface; "
                           : image                     ? "an image; "
                                                       : ""),
               same_word(kind, "POLYDATA") ? std::string(fill_vtk_surface)
               : image                     ? std::string(fill_vtk_image)
                       : std::string("only an unstructured grid holds tetrahedra: export the "
                                     "volume mesh"));
  }
}

void VtkParser::section(std::string_view keyword) {
  if (same_word(keyword, "POINTS")) {
    points();
  } else if (same_word(keyword, "CELLS")) {
    cells();
  } else if (same_word(keyword, "CELL_TYPES")) {
    cell_types();
  } else if (same_word(keyword, "POINT_DATA")) {
    start_attributes(Owner::points);
  } else if (same_word(keyword, "CELL_DATA")) {
    start_attributes(Owner::cells);
  } else if (same_word(keyword, "FIELD")) {
    field();
  } else if (same_word(keyword, "METADATA")) {
    metadata();
  } else if (owner_ == Owner::grid || !attribute(keyword)) {
    constexpr std::array<std::string_view, 10> known = {
        "POINTS", "CELLS",    "CELL_TYPES", "POINT_DATA",   "CELL_DATA",
        "FIELD",  "METADATA", "SCALARS",    "LOOKUP_TABLE", "VECTORS"};
    const std::string meant = nearest(keyword, known);
    text_.fail(fmt::format("expected a section, found {}", quoted(keyword)),
               meant.empty() ? std::string("a count before it may be too small; otherwise remove "
                                           "this section")
                             : fmt::format("did you mean {}? If a number stands here, a count "
                                           "before it is too small",
                                           meant));
  }
}

void VtkParser::points() {
  if (has_points_) text_.fail("a second section POINTS", "join the two sections into one");
  has_points_ = true;
  text_.set_part("a point", "x y z");
  const Wanted wanted{"the number of points"};
  const std::size_t points = values_.count(wanted);
  const Scalar type = values_.scalar({"the type of the coordinates"});
  values_.start_data(wanted);
  values_.check_room(points, 3, type, wanted);
  grid_.points.reserve(points);
  for (std::size_t i = 0; i < points; ++i) {
    const auto id = static_cast<std::int64_t>(i);
    const double x = values_.number(type, {"x", "point", id});
    const double y = values_.number(type, {"y", "point", id});
    const double z = values_.number(type, {"z", "point", id});
    grid_.points.emplace_back(x, y, z);
  }
}

void VtkParser::cells() {
  if (has_cells_) text_.fail("a second section CELLS", "join the two sections into one");
  if (!has_points_) text_.fail("CELLS stands before POINTS", "put the section POINTS first");
  has_cells_ = true;
  const Wanted first_wanted{has_offsets_ ? "the number of offsets" : "the number of cells"};
  const std::size_t first = values_.count(first_wanted);
  const Wanted size_wanted{"the size of the cell list"};
  const std::size_t size = values_.count(size_wanted);
  if (has_offsets_) {
    cells_with_offsets(first, size);
    return;
  }
  text_.set_part("a cell", "number-of-points point point ...");
  values_.start_data(size_wanted);
  values_.check_room(size, 1, Scalar::i32, size_wanted);
  if (first > size) {
    text_.fail(fmt::format("{} cells cannot be listed in {} numbers", first, size),
               "CELLS has two counts: the cells, and all numbers that follow");
  }
  cells_with_sizes(first, size);
}

std::int64_t VtkParser::point_id(Scalar type, std::size_t cell) {
  const std::int64_t id =
      values_.integer(type, {"a point", "cell", static_cast<std::int64_t>(cell)});
  if (id < 0 || id >= static_cast<std::int64_t>(grid_.points.size())) {
    text_.fail(fmt::format("cell {} names point {}; the file has points 0 to {}", cell, id,
                           static_cast<std::int64_t>(grid_.points.size()) - 1),
               "correct the id (VTK counts from 0), or add the missing points");
  }
  return id;
}

void VtkParser::cells_with_sizes(std::size_t count, std::size_t size) {
  grid_.offsets.reserve(count);
  grid_.connectivity.reserve(size - count);
  std::size_t left = size;
  for (std::size_t i = 0; i < count; ++i) {
    const Wanted wanted{"number of points", "cell", static_cast<std::int64_t>(i)};
    const std::int64_t points = values_.integer(Scalar::i32, wanted);
    const std::size_t room = left - (count - i);
    if (points < 0 || static_cast<std::uint64_t>(points) > room) {
      text_.fail(fmt::format("{} is {}, but the size of the cell list leaves room for {}",
                             to_text(wanted), points, room),
                 "CELLS has two counts: the cells, and all numbers that follow; correct them or "
                 "the cell");
    }
    for (std::int64_t k = 0; k < points; ++k) {
      grid_.connectivity.push_back(point_id(Scalar::i32, i));
    }
    left -= 1 + static_cast<std::size_t>(points);
    grid_.offsets.push_back(static_cast<std::int64_t>(grid_.connectivity.size()));
  }
  if (left != 0) {
    text_.fail(fmt::format("the cells take {} numbers, but the size of the cell list is {}",
                           size - left, size),
               "CELLS has two counts: the cells, and all numbers that follow; correct them");
  }
}

void VtkParser::cells_with_offsets(std::size_t offsets, std::size_t size) {
  const auto list = [&](std::string_view keyword, std::size_t length, const Wanted& wanted) {
    const std::string_view found = text_.word({keyword});
    if (!same_word(found, keyword)) {
      text_.fail(fmt::format("expected {}, found {}", keyword, quoted(found)),
                 "since version 5, CELLS holds an OFFSETS and a CONNECTIVITY list; correct the "
                 "version in line 1 if the file is older");
    }
    const Scalar type = values_.scalar({"the type of the list", keyword});
    values_.start_data(wanted);
    values_.check_room(length, 1, type, wanted);
    return type;
  };
  const Scalar offset_type = list("OFFSETS", offsets, {"the number of offsets"});
  text_.set_part("a list of OFFSETS", "0 and the end of each cell in CONNECTIVITY");
  grid_.offsets.reserve(offsets);
  for (std::size_t i = 0; i < offsets; ++i) {
    const Wanted wanted{"offset", "cell", static_cast<std::int64_t>(i)};
    const std::int64_t offset = values_.integer(offset_type, wanted);
    if (i == 0 && offset != 0) text_.fail_expected(wanted, "0", std::to_string(offset));
    if (i > 0) grid_.offsets.push_back(offset);
  }
  const Scalar type = list("CONNECTIVITY", size, {"the size of the connectivity"});
  text_.set_part("a list of CONNECTIVITY", "the points of one cell after the other");
  grid_.connectivity.reserve(size);
  std::size_t cell = 0;
  for (std::size_t i = 0; i < size; ++i) {
    while (cell < grid_.offsets.size() && grid_.offsets[cell] <= static_cast<std::int64_t>(i)) {
      ++cell;
    }
    grid_.connectivity.push_back(point_id(type, cell));
  }
}

void VtkParser::cell_types() {
  if (has_types_) text_.fail("a second section CELL_TYPES", "join the two sections into one");
  has_types_ = true;
  text_.set_part("a list of CELL_TYPES", "a number for each cell, 10 is a tetrahedron");
  const Wanted wanted{"the number of cell types"};
  const std::size_t types = values_.count(wanted);
  values_.start_data(wanted);
  values_.check_room(types, 1, Scalar::i32, wanted);
  grid_.types.reserve(types);
  for (std::size_t i = 0; i < types; ++i) {
    grid_.types.push_back(static_cast<int>(
        values_.integer(Scalar::i32, {"type", "cell", static_cast<std::int64_t>(i)})));
  }
}

void VtkParser::start_attributes(Owner owner) {
  owner_ = owner;
  const Wanted wanted{owner == Owner::points ? "the number of POINT_DATA values"
                                             : "the number of CELL_DATA values"};
  tuples_ = values_.count(wanted);
  const std::size_t expected = owner == Owner::points ? grid_.points.size() : grid_.offsets.size();
  if (tuples_ != expected) {
    text_.fail(
        fmt::format("{} is {}; the file has {} {}", to_text(wanted), tuples_, expected,
                    owner == Owner::points ? "points" : "cells"),
        "POINT_DATA and CELL_DATA stand behind the points and cells and have as many values");
  }
}

bool VtkParser::attribute(std::string_view keyword) {
  struct Kind {
    std::string_view keyword;
    std::size_t components;
  };
  constexpr std::array kinds = {Kind{"VECTORS", 3},    Kind{"NORMALS", 3},
                                Kind{"TENSORS", 9},    Kind{"TENSORS6", 6},
                                Kind{"GLOBAL_IDS", 1}, Kind{"PEDIGREE_IDS", 1}};
  for (const Kind& kind : kinds) {
    if (!same_word(keyword, kind.keyword)) continue;
    const std::string name = decoded_name(text_.word({"the name of an array"}));
    array(name, kind.components, tuples_);
    return true;
  }
  const bool color = same_word(keyword, "COLOR_SCALARS");
  const bool texture = same_word(keyword, "TEXTURE_COORDINATES");
  const bool table = same_word(keyword, "LOOKUP_TABLE");
  if (same_word(keyword, "SCALARS")) {
    scalars();
  } else if (color || texture || table) {
    text_.word({"the name of an array"});
    const std::size_t n = values_.count({"the size of the array"});
    const Scalar type = texture ? values_.scalar({"the type of an array"}) : Scalar::u8;
    values_.skip_array(table ? 4 : n, table ? n : tuples_, type);
  } else {
    return false;
  }
  return true;
}

void VtkParser::scalars() {
  const std::string name = decoded_name(text_.word({"the name of an array"}));
  if (values_.is_text()) return array(name, 1, tuples_);
  const Scalar type = values_.scalar({"the type of an array"});
  std::size_t components = 1;
  if (!text_.at_line_end()) {
    components = static_cast<std::size_t>(text_.integer({"the number of components"}, 1, 1000));
  }
  // The line "LOOKUP_TABLE name" is optional.
  if (same_word(text_.peek(), "LOOKUP_TABLE")) {
    text_.word({"LOOKUP_TABLE"});
    text_.word({"the name of the lookup table"});
  }
  array(name, components, tuples_, type);
}

void VtkParser::field() {
  text_.word({"the name of the field"});
  const std::size_t arrays = values_.count({"the number of arrays in the field"});
  for (std::size_t i = 0; i < arrays; ++i) {
    if (same_word(text_.peek(), "METADATA")) {
      text_.word({"METADATA"});
      metadata();
    }
    const std::string name = decoded_name(text_.word({"the name of an array"}));
    const std::size_t components = values_.count({"the number of components"});
    const std::size_t tuples = values_.count({"the number of tuples"});
    array(name, components, tuples);
  }
}

// Up to the next empty line.
void VtkParser::metadata() {
  text_.line_rest();
  while (text_.remaining() > 0 && !text_.line_rest().empty()) {
  }
}

void VtkParser::array(std::string name, std::size_t components, std::size_t tuples) {
  if (!values_.is_text()) {
    return array(std::move(name), components, tuples, values_.scalar({"the type of an array"}));
  }
  values_.skip_text_array(components, tuples);
  if (owner_ == Owner::grid) return;
  (owner_ == Owner::cells ? grid_.cell_arrays : grid_.point_arrays)
      .add(std::move(name), ArrayKind::text, {});
}

void VtkParser::array(std::string name, std::size_t components, std::size_t tuples, Scalar type) {
  if (owner_ == Owner::grid) return values_.skip_array(components, tuples, type);
  LabelArrays& arrays = owner_ == Owner::cells ? grid_.cell_arrays : grid_.point_arrays;
  const bool real = type == Scalar::f32 || type == Scalar::f64;
  if (components != 1 || tuples != tuples_ || type == Scalar::bit ||
      (real && !arrays.wants(name))) {
    values_.skip_array(components, tuples, type);
    arrays.add(std::move(name), components > 1 ? ArrayKind::vector : ArrayKind::fractional, {});
    return;
  }
  const Wanted wanted{"the number of values of an array"};
  values_.start_data(wanted);
  values_.check_room(tuples, 1, type, wanted);
  auto found = std::make_shared<std::vector<double>>();
  found->reserve(tuples);
  for (std::size_t i = 0; i < tuples; ++i) {
    found->push_back(values_.number(type, {"value", name, static_cast<std::int64_t>(i)}));
  }
  arrays.add(std::move(name), real ? ArrayKind::fractional : ArrayKind::whole,
             [found] { return *found; });
}

}  // namespace

TetMesh parse_vtk(std::string_view bytes, const std::string& name, const LabelNames& labels,
                  ReadNotes* notes) {
  ReadNotes unread;
  return VtkParser(bytes, name, labels, notes == nullptr ? unread : *notes).parse();
}

}  // namespace sinew::io
