// PLY (G. Turk, "The PLY polygon file format", 1994), version 1.0 as text or bytes of either order.
// Elements vertex (x, y, z) and face (the list vertex_indices or vertex_index) are read, all others
// and all other properties are skipped.
#include <fmt/format.h>

#include <bit>

#include "sinew/io/surface_file.h"
#include "sinew/io/value_reader.h"

namespace sinew::io {
namespace {

enum class Type { i8, u8, i16, u16, i32, u32, f32, f64 };

struct Property {
  std::string name;
  Type type = Type::f32;  // of a value, or of a list's items
  bool list = false;
  Type length = Type::u8;  // of a list's length
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

class PlyParser {
 public:
  PlyParser(std::string_view bytes, const std::string& file)
      : text_(bytes, file, 0), values_(text_) {}

  SurfaceSoup parse() {
    header();
    for (const Element& element : elements_) {
      if (element.name == "vertex") {
        vertices(element);
      } else if (element.name == "face") {
        faces(element);
      } else {
        for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i) {
          for (const Property& p : element.properties) skip(p, element, i);
        }
      }
    }
    if (nodes_.empty()) {
      text_.fail_file("has no vertices", "export the surface again");
    }
    return polygons_.triangulate(std::move(nodes_), 0, text_.file());
  }

 private:
  Type type() {
    const Wanted wanted{"the type of a property"};
    const std::string_view name = text_.word(wanted);
    if (name == "char" || name == "int8") return Type::i8;
    if (name == "uchar" || name == "uint8") return Type::u8;
    if (name == "short" || name == "int16") return Type::i16;
    if (name == "ushort" || name == "uint16") return Type::u16;
    if (name == "int" || name == "int32") return Type::i32;
    if (name == "uint" || name == "uint32") return Type::u32;
    if (name == "float" || name == "float32") return Type::f32;
    if (name == "double" || name == "float64") return Type::f64;
    text_.fail_expected(wanted, "char, uchar, short, ushort, int, uint, float or double", name);
  }

  void header() {
    const std::string_view magic = text_.word({"ply"});
    if (magic != "ply") {
      text_.fail(fmt::format("expected ply, found {}", quoted(magic)),
                 "a PLY file starts with the line \"ply\"");
    }
    bool binary = false, swap = false, has_format = false;
    while (true) {
      const std::string_view keyword = text_.word({"end_header"});
      if (keyword == "format") {
        const std::string_view format = text_.word({"the format"});
        binary = format != "ascii";
        const bool big = format == "binary_big_endian";
        if (binary && !big && format != "binary_little_endian") {
          text_.fail_expected({"the format"}, "ascii, binary_little_endian or binary_big_endian",
                              format);
        }
        swap = big != (std::endian::native == std::endian::big);
        has_format = true;
        text_.line_rest();
      } else if (keyword == "element") {
        Element element;
        element.name = text_.word({"the name of an element"});
        element.count =
            static_cast<std::uint64_t>(text_.integer({"the number of", element.name}, 0, 1 << 30));
        elements_.push_back(std::move(element));
      } else if (keyword == "property") {
        property();
      } else if (keyword == "comment" || keyword == "obj_info") {
        text_.line_rest();
      } else if (keyword == "end_header") {
        break;
      } else {
        text_.fail_expected({"a line of the header"},
                            "format, element, property, comment or end_header", keyword);
      }
    }
    if (!has_format) {
      text_.fail_file("its header names no format", "add the line \"format ascii 1.0\"");
    }
    text_.end_line({"the first element"});
    if (binary) values_.set_binary(swap);
  }

  void property() {
    if (elements_.empty()) {
      text_.fail("a property before the first element", "put \"element vertex N\" before it");
    }
    Property p;
    if (text_.peek() == "list") {
      text_.word({"list"});
      p.list = true;
      p.length = type();
    }
    p.type = type();
    p.name = text_.word({"the name of a property"});
    elements_.back().properties.push_back(std::move(p));
  }

  double number(Type type, const Wanted& wanted) {
    switch (type) {
      case Type::i8:
        return values_.value<std::int8_t>(wanted);
      case Type::u8:
        return values_.value<std::uint8_t>(wanted);
      case Type::i16:
        return values_.value<std::int16_t>(wanted);
      case Type::u16:
        return values_.value<std::uint16_t>(wanted);
      case Type::i32:
        return values_.value<std::int32_t>(wanted);
      case Type::u32:
        return values_.value<std::uint32_t>(wanted);
      case Type::f32:
        return values_.value<float>(wanted);
      case Type::f64:
        break;
    }
    return values_.value<double>(wanted);
  }

  std::uint64_t length(const Property& p, const Element& element, std::uint64_t i) {
    const Wanted wanted{"the length of a list", element.name, static_cast<std::int64_t>(i)};
    const double found = number(p.length, wanted);
    if (!(found >= 0) || found > 1e9) {
      text_.fail(fmt::format("{} is {}", to_text(wanted), found), "export the surface again");
    }
    const auto items = static_cast<std::uint64_t>(found);
    values_.check_room(items, 1, 1, wanted);
    return items;
  }

  void skip(const Property& p, const Element& element, std::uint64_t i) {
    const Wanted wanted{"a value", element.name, static_cast<std::int64_t>(i)};
    const std::uint64_t values = p.list ? length(p, element, i) : 1;
    for (std::uint64_t k = 0; k < values; ++k) number(p.type, wanted);
  }

  void vertices(const Element& element) {
    std::array<bool, 3> found{};
    for (const Property& p : element.properties) {
      if (p.name.size() == 1 && p.name[0] >= 'x' && p.name[0] <= 'z' && !p.list) {
        found[static_cast<std::size_t>(p.name[0] - 'x')] = true;
      }
    }
    if (!found[0] || !found[1] || !found[2]) {
      text_.fail_file("its vertices lack a property x, y or z", "export the surface again");
    }
    values_.check_room(element.count, element.properties.size(), 3, {"the number of vertices"});
    nodes_.reserve(element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      Vec3 x = Vec3::Zero();
      for (const Property& p : element.properties) {
        const char axis = p.name.size() == 1 && !p.list ? p.name[0] : '\0';
        if (axis >= 'x' && axis <= 'z') {
          x[axis - 'x'] = number(p.type, {p.name, "vertex", static_cast<std::int64_t>(i)});
        } else {
          skip(p, element, i);
        }
      }
      nodes_.push_back(x);
    }
  }

  void faces(const Element& element) {
    const auto is_corners = [](const Property& p) {
      return p.list && (p.name == "vertex_indices" || p.name == "vertex_index");
    };
    if (std::none_of(element.properties.begin(), element.properties.end(), is_corners)) {
      text_.fail_file("its faces lack the list vertex_indices", "export the surface again");
    }
    for (std::uint64_t i = 0; i < element.count; ++i) {
      bool started = false;
      for (const Property& p : element.properties) {
        if (!is_corners(p) || started) {
          skip(p, element, i);
          continue;
        }
        const std::uint64_t corners = length(p, element, i);
        polygons_.start();
        started = true;
        for (std::uint64_t k = 0; k < corners; ++k) {
          const Wanted wanted{"a vertex", "face", static_cast<std::int64_t>(i + 1)};
          const double id = number(p.type, wanted);
          // A value that is not an id is reported with the ids out of range.
          polygons_.add(id >= -1e9 && id <= 4.3e9 ? static_cast<std::int64_t>(id) : -1);
        }
      }
    }
  }

  TextReader text_;
  ValueReader values_;
  std::vector<Element> elements_;
  std::vector<Vec3> nodes_;
  PolygonList polygons_;
};

}  // namespace

SurfaceSoup parse_ply(std::string_view bytes, const std::string& file) {
  return PlyParser(bytes, file).parse();
}

}  // namespace sinew::io
