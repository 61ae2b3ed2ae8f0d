// OFF (Geomview): [ST][C][N]OFF, the numbers of vertices, faces and edges, a line for each vertex
// and each face; # starts a comment. Further values of a vertex (normals, colours) and of a
// face (colours) are skipped.
#include <fmt/format.h>

#include "sinew/io/surface_file.h"
#include "sinew/io/text_reader.h"

namespace sinew::io {

SurfaceSoup parse_off(std::string_view text, const std::string& file) {
  TextReader reader(text, file, '#');
  const std::string_view header = reader.word({"OFF"});
  const bool known = header == "OFF" || header == "COFF" || header == "NOFF" || header == "CNOFF" ||
                     header == "STOFF" || header == "STCOFF" || header == "STNOFF" ||
                     header == "STCNOFF";
  if (!known) {
    reader.fail(fmt::format("expected OFF, found {}", quoted(header)),
                "an OFF file starts with OFF, NOFF or COFF in a line of its own");
  }
  if (reader.peek() == "BINARY") {
    reader.word({"the number of vertices"});
    reader.fail("is a binary OFF file", "export it as text, or as PLY or STL");
  }
  const std::size_t vertices = reader.count({"the number of vertices"}, 3);
  const std::size_t faces = reader.count({"the number of faces"}, 4);
  if (!reader.at_line_end()) reader.word({"the number of edges"});

  reader.set_part("a vertex", "x y z");
  std::vector<Vec3> nodes;
  nodes.reserve(vertices);
  for (std::size_t i = 0; i < vertices; ++i) {
    const auto number = static_cast<std::int64_t>(i);
    const double x = reader.real({"x", "vertex", number});
    const double y = reader.real({"y", "vertex", number});
    const double z = reader.real({"z", "vertex", number});
    nodes.emplace_back(x, y, z);
    reader.line_rest();
  }
  reader.set_part("a face", "corners vertex vertex vertex ...");
  PolygonList polygons;
  for (std::size_t i = 0; i < faces; ++i) {
    const auto number = static_cast<std::int64_t>(i + 1);
    const std::size_t corners = reader.count({"the number of corners", "face", number}, 1);
    polygons.start();
    for (std::size_t k = 0; k < corners; ++k) {
      polygons.add(reader.integer({"a vertex", "face", number}));
    }
    reader.line_rest();
  }
  return polygons.triangulate(std::move(nodes), 0, file);
}

}  // namespace sinew::io
