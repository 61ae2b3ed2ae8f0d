// OBJ (Wavefront): lines "v x y z" and "f a b c ...", where a corner is an id from 1, or from the
// last vertex backwards if negative, perhaps with texture and normal: 7/1/3. All other lines are
// skipped; a backslash at the end of a line joins it with the next.
#include <fmt/format.h>

#include <charconv>

#include "sinew/io/surface_file.h"
#include "sinew/io/text_reader.h"

namespace sinew::io {
namespace {

void corner(TextReader& reader, std::int64_t vertices, std::int64_t face, PolygonList& polygons) {
  const Wanted wanted{"a vertex", "face", face};
  const std::string_view word = reader.word(wanted);
  std::int64_t id = 0;
  const auto [stop, code] = std::from_chars(word.data(), word.data() + word.size(), id);
  const bool ends = stop == word.data() + word.size() || *stop == '/';
  if (code != std::errc{} || !ends || id == 0) {
    reader.fail_expected(wanted, "an id from 1, as in 7 or 7/1/3", word);
  }
  // An id out of range is reported at the end, when all vertices are known.
  polygons.add(id > 0 ? id - 1 : (-id <= vertices ? vertices + id : vertices));
}

}  // namespace

SurfaceSoup parse_obj(std::string_view text, const std::string& file) {
  TextReader reader(text, file, '#');
  std::vector<Vec3> nodes;
  PolygonList polygons;
  while (!reader.at_end()) {
    const std::string_view keyword = reader.word({"a keyword"});
    if (keyword == "v") {
      reader.set_part("a vertex", "v x y z");
      const auto number = static_cast<std::int64_t>(nodes.size() + 1);
      const double x = reader.real({"x", "vertex", number});
      const double y = reader.real({"y", "vertex", number});
      const double z = reader.real({"z", "vertex", number});
      nodes.emplace_back(x, y, z);
    } else if (keyword == "f") {
      reader.set_part("a face", "f vertex vertex vertex ...");
      const auto number = static_cast<std::int64_t>(polygons.size() + 1);
      polygons.start();
      while (!reader.at_line_end()) {
        if (reader.peek() == "\\") {
          reader.line_rest();
          continue;
        }
        corner(reader, static_cast<std::int64_t>(nodes.size()), number, polygons);
      }
    } else if (keyword.find('\0') != keyword.npos) {
      reader.fail("is not text", "an OBJ file has lines \"v x y z\" and \"f a b c\"");
    }
    reader.line_rest();
  }
  if (nodes.empty()) {
    reader.fail_file("has no vertices: no line starts with \"v\"",
                     "an OBJ file has lines \"v x y z\" and \"f a b c\"; check that it is one");
  }
  return polygons.triangulate(std::move(nodes), 1, file);
}

}  // namespace sinew::io
