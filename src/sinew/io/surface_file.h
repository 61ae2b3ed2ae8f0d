// Surfaces from a file: OFF, OBJ, STL (text and binary) and PLY (text and binary).
//
// The result is a triangle soup in the order of the file, without any repair. The mesher
// (apps/sinew-mesh) checks whether the triangles bound a volume.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/base/vec.h"

namespace sinew::io {

struct SurfaceSoup {
  std::vector<Vec3> nodes;          // position, in the file's unit; finite (nodes)
  std::vector<Triangle> triangles;  // node ids, in range; a triangle may repeat a node (triangles)
  std::size_t polygons = 0;         // faces of the file, before polygons were split
};

// The polygons of a file, collected until all nodes are known.
class PolygonList {
 public:
  void start() { starts_.push_back(corners_.size()); }
  void add(std::int64_t node) { corners_.push_back(node); }
  std::size_t size() const { return starts_.size(); }

  // Checks ids and coordinates and splits polygons with more than three corners. `first_id` is the
  // id of the format's first node, for messages; ids in the list count from 0. Error (input): an id
  // out of range, fewer than three corners, a coordinate that is nan, infinite or beyond 1e50, no
  // faces at all.
  SurfaceSoup triangulate(std::vector<Vec3> nodes, std::int64_t first_id,
                          const std::string& file) const;

 private:
  std::vector<std::size_t> starts_;    // start of each polygon in corners_ (polygons)
  std::vector<std::int64_t> corners_;  // node ids from 0, not checked yet
};

// The whole text of a file; `file` names it in errors. Error (input) for any other file.
SurfaceSoup parse_off(std::string_view text, const std::string& file);
SurfaceSoup parse_obj(std::string_view text, const std::string& file);
SurfaceSoup parse_stl(std::string_view bytes, const std::string& file);
SurfaceSoup parse_ply(std::string_view bytes, const std::string& file);

// The format follows from the extension, case ignored.
SurfaceSoup read_surface(const std::filesystem::path& path);

// {".off", ".obj", ".stl", ".ply"}
const std::vector<std::string>& surface_endings();

// Whether the name has one of these extensions, case ignored.
bool is_surface_name(const std::filesystem::path& path);

}  // namespace sinew::io
