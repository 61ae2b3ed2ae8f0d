// STL, text ("solid NAME", "facet", "vertex x y z") and binary (80 bytes, the number of triangles,
// 50 bytes each). Every triangle has its own corners; corners at the same position become one node.
#include <fmt/format.h>

#include <array>
#include <cstring>
#include <limits>
#include <unordered_map>

#include "sinew/base/error.h"
#include "sinew/io/surface_file.h"
#include "sinew/io/value_reader.h"

namespace sinew::io {
namespace {

constexpr std::size_t stl_header_bytes = 84;
constexpr std::size_t triangle_bytes = 50;

// Nodes by the bits of their position; -0 counts as 0.
class Corners {
 public:
  std::int64_t id(const Vec3& x) {
    std::string key(sizeof(double) * 3, '\0');
    const std::array<double, 3> bits = {x.x() + 0.0, x.y() + 0.0, x.z() + 0.0};
    std::memcpy(key.data(), bits.data(), key.size());
    const auto [entry, added] = ids_.emplace(std::move(key), nodes.size());
    if (added) nodes.push_back(x);
    return static_cast<std::int64_t>(entry->second);
  }

  std::vector<Vec3> nodes;

 private:
  std::unordered_map<std::string, std::size_t> ids_;
};

std::uint64_t promised_triangles(std::string_view bytes) {
  constexpr bool swap = std::endian::native == std::endian::big;
  return from_bytes<std::uint32_t>(bytes.data() + 80, swap);
}

SurfaceSoup parse_binary(std::string_view bytes, const std::string& file) {
  constexpr bool swap = std::endian::native == std::endian::big;
  const std::uint64_t promised = promised_triangles(bytes);
  const std::uint64_t room = (bytes.size() - stl_header_bytes) / triangle_bytes;
  if (promised > room) {
    throw Error(ErrorKind::input,
                fmt::format("promises {} triangles, but its {} bytes hold only {}", promised,
                            bytes.size(), room),
                cut_short, {file});
  }
  Corners corners;
  PolygonList polygons;
  for (std::uint64_t t = 0; t < promised; ++t) {
    const char* at = bytes.data() + stl_header_bytes + t * triangle_bytes + 12;  // after the normal
    polygons.start();
    for (int k = 0; k < 3; ++k, at += 12) {
      polygons.add(corners.id({from_bytes<float>(at, swap), from_bytes<float>(at + 4, swap),
                               from_bytes<float>(at + 8, swap)}));
    }
  }
  return polygons.triangulate(std::move(corners.nodes), 1, file);
}

SurfaceSoup parse_text(std::string_view text, const std::string& file) {
  TextReader reader(text, file, 0);
  reader.set_part("a triangle",
                  "facet ..., outer loop, three times vertex x y z, endloop, endfacet");
  Corners corners;
  PolygonList polygons;
  bool in_loop = false;
  reader.line_rest();  // solid and its name, which may hold anything
  while (!reader.at_end()) {
    const std::string_view word = reader.word({"a keyword"});
    if (word == "vertex" && in_loop) {
      const auto number = static_cast<std::int64_t>(polygons.size());
      const double x = reader.real({"x of a corner", "triangle", number});
      const double y = reader.real({"y of a corner", "triangle", number});
      const double z = reader.real({"z of a corner", "triangle", number});
      polygons.add(corners.id({x, y, z}));
    } else if (word == "outer") {
      if (in_loop) reader.fail("a loop begins before the last has ended", cut_short);
      reader.word({"loop"});
      polygons.start();
      in_loop = true;
    } else if (word == "endloop") {
      in_loop = false;
    } else if (word == "facet" || word == "solid" || word == "endsolid") {
      reader.line_rest();  // a normal, or a name
    } else if (word != "endfacet") {
      reader.fail_expected({"a keyword"},
                           "facet, outer loop, vertex, endloop, endfacet or endsolid", word);
    }
  }
  if (in_loop) {
    reader.fail_file(fmt::format("ends within triangle {}", polygons.size()), cut_short);
  }
  return polygons.triangulate(std::move(corners.nodes), 1, file);
}

}  // namespace

SurfaceSoup parse_stl(std::string_view bytes, const std::string& file) {
  // Some binary files begin with "solid" too; their length identifies them, or bytes that no text
  // has.
  const bool exact = bytes.size() >= stl_header_bytes &&
                     bytes.size() == stl_header_bytes + triangle_bytes * promised_triangles(bytes);
  const bool text =
      bytes.starts_with("solid") && bytes.substr(0, 1024).find('\0') == std::string_view::npos;
  if (text && !exact) return parse_text(bytes, file);
  if (bytes.size() < stl_header_bytes) {
    throw Error(
        ErrorKind::input,
        fmt::format("is not an STL file: it does not begin with \"solid\", and a binary one "
                    "has at least {} bytes, not {}",
                    stl_header_bytes, bytes.size()),
        "export the surface again", {file});
  }
  return parse_binary(bytes, file);
}

}  // namespace sinew::io
