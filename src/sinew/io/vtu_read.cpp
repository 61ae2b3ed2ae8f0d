#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <limits>
#include <pugixml.hpp>
#include <utility>

#include "sinew/base/error.h"
#include "sinew/io/text_reader.h"
#include "sinew/io/value_reader.h"
#include "sinew/io/vtk_grid.h"
#include "sinew/io/vtu.h"
#include "sinew/io/vtu_data.h"

namespace sinew::io {
namespace {

constexpr std::string_view export_again =
    "export the file again (in ParaView: Save Data, type VTU, any data mode)";
// Real meshes compress by a factor of less than a hundred. A small file that would expand to
// gigabytes is refused before it is expanded.
constexpr std::size_t trusted_expansion = 256;
constexpr std::size_t always_trusted = std::size_t{64} << 20;
constexpr auto any_size = std::numeric_limits<std::size_t>::max();

std::size_t type_bytes(std::string_view type) {
  if (type == "Int8" || type == "UInt8") return 1;
  if (type == "Int16" || type == "UInt16") return 2;
  if (type == "Int32" || type == "UInt32" || type == "Float32") return 4;
  if (type == "Int64" || type == "UInt64" || type == "Float64") return 8;
  return 0;
}

template <typename Stored, typename T>
void convert(std::string_view bytes, bool swap, std::vector<T>& values) {
  for (std::size_t at = 0; at + sizeof(Stored) <= bytes.size(); at += sizeof(Stored)) {
    values.push_back(static_cast<T>(from_bytes<Stored>(bytes.data() + at, swap)));
  }
}

template <typename T>
void convert(std::string_view type, std::string_view bytes, bool swap, std::vector<T>& values) {
  if (type == "Int8") convert<std::int8_t>(bytes, swap, values);
  if (type == "UInt8") convert<std::uint8_t>(bytes, swap, values);
  if (type == "Int16") convert<std::int16_t>(bytes, swap, values);
  if (type == "UInt16") convert<std::uint16_t>(bytes, swap, values);
  if (type == "Int32") convert<std::int32_t>(bytes, swap, values);
  if (type == "UInt32") convert<std::uint32_t>(bytes, swap, values);
  if (type == "Int64") convert<std::int64_t>(bytes, swap, values);
  if (type == "UInt64") convert<std::uint64_t>(bytes, swap, values);
  if constexpr (std::is_floating_point_v<T>) {
    if (type == "Float32") convert<float>(bytes, swap, values);
    if (type == "Float64") convert<double>(bytes, swap, values);
  }
}

class VtuParser {
 public:
  VtuParser(std::string_view bytes, const std::string& name, const LabelNames& asked,
            ReadNotes& notes)
      : bytes_(bytes),
        name_(name),
        asked_(asked),
        notes_(notes),
        trusted_(trusted_expansion * bytes.size() + always_trusted) {}

  TetMesh parse();

 private:
  void load();
  void read_form(const pugi::xml_node& root);
  pugi::xml_node only_child(const pugi::xml_node& parent, const char* child) const;
  std::size_t count(const pugi::xml_node& node, const char* attribute) const;
  pugi::xml_node named_array(const pugi::xml_node& parent, std::string_view name) const;
  void list_arrays(const pugi::xml_node& data, std::size_t count, LabelArrays& arrays);
  // The numbers of a DataArray; `expected`: how many, or any_size.
  template <typename T>
  std::vector<T> values(const pugi::xml_node& array, std::size_t expected);
  template <typename T>
  std::vector<T> text_values(const pugi::xml_node& array, std::string_view label,
                             std::size_t expected);
  std::string binary_values(const pugi::xml_node& array, const std::string& label,
                            std::size_t most) const;
  // The text of a node as the file has it.
  std::string_view text_of(const pugi::xml_node& node) const;
  [[noreturn]] void fail(std::ptrdiff_t offset, std::string message, std::string remedy) const;
  [[noreturn]] void fail_at(const pugi::xml_node& node, std::string message,
                            std::string_view remedy) const {
    fail(node.offset_debug() - 1, std::move(message), std::string(remedy));
  }

  std::string_view bytes_;
  const std::string& name_;
  const LabelNames& asked_;
  ReadNotes& notes_;
  std::size_t trusted_;  // remaining bytes that the arrays may decode to
  pugi::xml_document document_;
  std::string_view appended_;  // the appended data behind their underscore
  bool appended_raw_ = false;
  bool has_appended_ = false;
  VtuForm form_;
};

void VtuParser::fail(std::ptrdiff_t offset, std::string message, std::string remedy) const {
  TextReader place(bytes_, name_, 0);
  if (offset > 0) {
    place.go_to(std::min(static_cast<std::size_t>(offset), bytes_.size()));
  }
  place.fail(std::move(message), std::move(remedy));
}

// Appended data may be raw bytes, which are not XML: they are removed before the rest is parsed.
void VtuParser::load() {
  std::string head;
  const std::size_t tag = bytes_.find("<AppendedData");
  if (tag != bytes_.npos) {
    const std::size_t open = bytes_.find('>', tag);
    const std::size_t start = open == bytes_.npos ? open : bytes_.find('_', open);
    if (start == bytes_.npos) {
      fail(static_cast<std::ptrdiff_t>(tag), "the appended data do not start with an underscore",
           std::string(export_again));
    }
    const std::string_view attributes = bytes_.substr(tag, open - tag);
    appended_raw_ = attributes.find("raw") != attributes.npos;
    appended_ = bytes_.substr(start + 1);
    if (!appended_raw_) appended_ = appended_.substr(0, appended_.find('<'));
    has_appended_ = true;
    head = std::string(bytes_.substr(0, tag)) + "</VTKFile>";
  }
  const std::string_view xml = has_appended_ ? std::string_view(head) : bytes_;
  const pugi::xml_parse_result result =
      document_.load_buffer(xml.data(), xml.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!result) {
    fail(result.offset, fmt::format("is not well-formed XML: {}", result.description()),
         "is this a VTU file? If so it was cut short or damaged: export it again");
  }
}

void VtuParser::read_form(const pugi::xml_node& root) {
  const std::string_view kind = root.attribute("type").value();
  if (kind != "UnstructuredGrid") {
    fail_at(root,
            fmt::format("the type of VTKFile is {}, {}UnstructuredGrid was expected", quoted(kind),
                        kind == "PolyData"    ? "a surface; "
                        : kind == "ImageData" ? "an image; "
                                              : ""),
            kind == "PolyData"    ? fill_vtk_surface
            : kind == "ImageData" ? fill_vtk_image
                                  : "only an unstructured grid holds tetrahedra: export the volume "
                                    "mesh as VTU");
  }
  const std::string_view order = root.attribute("byte_order").as_string("LittleEndian");
  if (order != "LittleEndian" && order != "BigEndian") {
    fail_at(root,
            fmt::format("byte_order is {}; LittleEndian or BigEndian was expected", quoted(order)),
            export_again);
  }
  form_.swap = (order == "LittleEndian") != (std::endian::native == std::endian::little);
  const std::string_view header = root.attribute("header_type").as_string("UInt32");
  if (header != "UInt32" && header != "UInt64") {
    fail_at(root, fmt::format("header_type is {}; UInt32 or UInt64 was expected", quoted(header)),
            export_again);
  }
  form_.header_bytes = header == "UInt32" ? 4 : 8;
  const std::string_view compressor = root.attribute("compressor").value();
  if (!compressor.empty() && compressor != "vtkZLibDataCompressor") {
    fail_at(root,
            fmt::format("the compressor is {}; only vtkZLibDataCompressor can be read",
                        quoted(compressor)),
            "save the file with the compressor ZLib or none (in ParaView: Save Data, Compressor "
            "Type)");
  }
  form_.zlib = !compressor.empty();
}

TetMesh VtuParser::parse() {
  load();
  const pugi::xml_node root = document_.document_element();
  if (std::string_view(root.name()) != "VTKFile") {
    fail(root ? root.offset_debug() - 1 : 0,
         fmt::format("the root element is {}, VTKFile was expected", quoted(root.name())),
         "is this a VTU file?");
  }
  read_form(root);
  const pugi::xml_node piece = only_child(only_child(root, "UnstructuredGrid"), "Piece");
  const std::size_t points = count(piece, "NumberOfPoints");
  const std::size_t cells = count(piece, "NumberOfCells");

  VtkGrid grid(asked_);
  const pugi::xml_node position = only_child(only_child(piece, "Points"), "DataArray");
  if (position.attribute("NumberOfComponents").as_int(3) != 3) {
    fail_at(position,
            fmt::format("the points have {} components, 3 were expected",
                        position.attribute("NumberOfComponents").value()),
            "export a volume mesh: a tetrahedral mesh has three coordinates a point");
  }
  if (points > any_size / 3) {
    fail_at(piece, fmt::format("NumberOfPoints is {}, which no file can hold", points),
            export_again);
  }
  const std::vector<double> x = values<double>(position, 3 * points);
  grid.points.reserve(points);
  for (std::size_t i = 0; i < points; ++i) {
    grid.points.emplace_back(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
  }
  const pugi::xml_node list = only_child(piece, "Cells");
  grid.connectivity = values<std::int64_t>(named_array(list, "connectivity"), any_size);
  grid.offsets = values<std::int64_t>(named_array(list, "offsets"), cells);
  grid.types = values<int>(named_array(list, "types"), cells);
  list_arrays(piece.child("PointData"), points, grid.point_arrays);
  list_arrays(piece.child("CellData"), cells, grid.cell_arrays);
  return mesh_from_grid(std::move(grid), name_, notes_);
}

pugi::xml_node VtuParser::only_child(const pugi::xml_node& parent, const char* child) const {
  const pugi::xml_node found = parent.child(child);
  if (!found) {
    fail_at(parent, fmt::format("{} has no element {}", parent.name(), child), export_again);
  }
  if (found.next_sibling(child)) {
    fail_at(
        found.next_sibling(child), fmt::format("a second element {} in {}", child, parent.name()),
        "the parts of a mesh must be joined at their common points: in ParaView, use the filters "
        "Merge Blocks and Clean to Grid, then save");
  }
  return found;
}

std::size_t VtuParser::count(const pugi::xml_node& node, const char* attribute) const {
  const std::string_view text = node.attribute(attribute).value();
  TextReader number(text, name_, 0);
  if (!text.empty() && text.find_first_not_of("0123456789") == text.npos && text.size() < 19) {
    return static_cast<std::size_t>(number.integer({attribute}));
  }
  fail_at(node,
          fmt::format("expected {} (a whole number, 0 or more), found {}", attribute, quoted(text)),
          "the element Piece says how many points and cells follow: export the file again");
}

pugi::xml_node VtuParser::named_array(const pugi::xml_node& parent, std::string_view name) const {
  for (const pugi::xml_node& array : parent.children("DataArray")) {
    if (array.attribute("Name").value() == name) return array;
  }
  fail_at(parent, fmt::format("{} has no DataArray named {}", parent.name(), name), export_again);
}

void VtuParser::list_arrays(const pugi::xml_node& data, std::size_t count, LabelArrays& arrays) {
  for (const pugi::xml_node& array : data.children()) {
    const std::string_view element = array.name();
    if (element != "DataArray" && element != "Array") continue;  // Array: of text
    const std::string_view type = array.attribute("type").value();
    ArrayKind kind = ArrayKind::whole;
    if (element == "Array" || type_bytes(type) == 0) {
      kind = ArrayKind::text;
    } else if (array.attribute("NumberOfComponents").as_int(1) > 1) {
      kind = ArrayKind::vector;
    } else if (type.starts_with("Float")) {
      kind = ArrayKind::fractional;
    }
    arrays.add(array.attribute("Name").value(), kind,
               [this, array, count] { return values<double>(array, count); });
  }
}

template <typename T>
std::vector<T> VtuParser::values(const pugi::xml_node& array, std::size_t expected) {
  std::string label = array.attribute("Name").value();
  if (label.empty()) label = array.parent().name();
  const std::string_view type = array.attribute("type").value();
  const std::size_t bytes_each = type_bytes(type);
  if (bytes_each == 0 || (!std::is_floating_point_v<T> && type.starts_with("Float"))) {
    fail_at(array,
            fmt::format("array \"{}\" has type {}, {} was expected", label, quoted(type),
                        std::is_floating_point_v<T> ? "a number type such as Float64"
                                                    : "an integer type such as Int64"),
            export_again);
  }
  std::vector<T> found;
  if (std::string_view(array.attribute("format").as_string("ascii")) == "ascii") {
    found = text_values<T>(array, label, expected);
  } else {
    const std::size_t most = expected > any_size / bytes_each ? any_size : expected * bytes_each;
    const std::string bytes = binary_values(array, label, std::min(most, trusted_));
    trusted_ -= bytes.size();
    found.reserve(bytes.size() / bytes_each);
    convert(type, bytes, form_.swap, found);
  }
  if (expected != any_size && found.size() != expected) {
    fail_at(
        array,
        fmt::format("array \"{}\" has {} values, {} were expected", label, found.size(), expected),
        "NumberOfPoints and NumberOfCells must fit the arrays: correct them or export the file "
        "again");
  }
  return found;
}

std::string_view VtuParser::text_of(const pugi::xml_node& node) const {
  const pugi::xml_node text = node.first_child();
  if (text.type() != pugi::node_pcdata) return {};
  const auto start = static_cast<std::size_t>(text.offset_debug());
  return bytes_.substr(start, bytes_.find('<', start) - start);
}

template <typename T>
std::vector<T> VtuParser::text_values(const pugi::xml_node& array, std::string_view label,
                                      std::size_t expected) {
  const std::string_view text = text_of(array);
  std::vector<T> found;
  if (text.empty()) return found;
  const auto start = static_cast<std::size_t>(text.data() - bytes_.data());
  TextReader reader(bytes_.substr(0, start + text.size()), name_, 0);
  reader.go_to(start);
  reader.set_part("an array", "numbers divided by blanks");
  while (!reader.at_end()) {
    const Wanted wanted{"value", label, static_cast<std::int64_t>(found.size())};
    if (found.size() == expected) {
      reader.word(wanted);
      reader.fail(fmt::format("array \"{}\" has more than the {} values expected", label, expected),
                  "NumberOfPoints and NumberOfCells must fit the arrays: correct them or export "
                  "the file again");
    }
    if constexpr (std::is_floating_point_v<T>) {
      found.push_back(reader.real(wanted));
    } else {
      found.push_back(static_cast<T>(
          reader.integer(wanted, std::numeric_limits<T>::min(), std::numeric_limits<T>::max())));
    }
  }
  return found;
}

std::string VtuParser::binary_values(const pugi::xml_node& array, const std::string& label,
                                     std::size_t most) const {
  const std::string_view format = array.attribute("format").value();
  std::string_view text = text_of(array);
  if (format == "appended") {
    const std::uint64_t offset =
        array.attribute("offset").as_ullong(std::numeric_limits<std::uint64_t>::max());
    if (!has_appended_ || offset > appended_.size()) {
      fail_at(
          array,
          has_appended_
              ? fmt::format("array \"{}\" starts at byte {} of {} appended bytes", label,
                            quoted(array.attribute("offset").value()), appended_.size())
              : fmt::format("array \"{}\" is appended, but the file has no AppendedData", label),
          "the file was cut short or damaged: fetch or export it again");
    }
    text = appended_.substr(static_cast<std::size_t>(offset));
  } else if (format != "binary") {
    fail_at(array,
            fmt::format("array \"{}\" has format {}; ascii, binary or appended was expected", label,
                        quoted(format)),
            export_again);
  }
  std::string bytes;
  std::string problem;
  if (!decode_vtu_array(text, format == "appended" && appended_raw_, form_, most, bytes, problem)) {
    fail_at(array, fmt::format("array \"{}\" {}", label, problem),
            "the file was cut short or damaged: fetch or export it again");
  }
  return bytes;
}

}  // namespace

TetMesh parse_vtu(std::string_view bytes, const std::string& name, const LabelNames& labels,
                  ReadNotes* notes) {
  ReadNotes unread;
  return VtuParser(bytes, name, labels, notes == nullptr ? unread : *notes).parse();
}

}  // namespace sinew::io
