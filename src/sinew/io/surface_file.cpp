#include "sinew/io/surface_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "sinew/base/error.h"
#include "sinew/io/cells.h"
#include "sinew/io/file_io.h"

namespace sinew::io {
namespace fs = std::filesystem;
namespace {

constexpr double largest_coordinate = 1e50;  // as mesh/doctor.h

// The normal of a polygon times twice its area (Newell).
Vec3 newell_normal(std::span<const Index> polygon, const std::vector<Vec3>& x) {
  Vec3 normal = Vec3::Zero();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    normal += (x[uz(polygon[i])] - x[uz(polygon[0])])
                  .cross(x[uz(polygon[(i + 1) % polygon.size()])] - x[uz(polygon[0])]);
  }
  return normal;
}

// Whether triangle a, b, c of a polygon with this normal is convex there and holds no other corner.
bool is_ear(const std::vector<Index>& left, std::size_t at, const Vec3& normal,
            const std::vector<Vec3>& x) {
  const std::size_t n = left.size();
  const Vec3& a = x[uz(left[(at + n - 1) % n])];
  const Vec3& b = x[uz(left[at])];
  const Vec3& c = x[uz(left[(at + 1) % n])];
  if (!((b - a).cross(c - b).dot(normal) > 0)) return false;
  for (std::size_t i = 0; i < n; ++i) {
    if (i == at || i == (at + 1) % n || i == (at + n - 1) % n) continue;
    const Vec3& p = x[uz(left[i])];
    if ((b - a).cross(p - a).dot(normal) >= 0 && (c - b).cross(p - b).dot(normal) >= 0 &&
        (a - c).cross(p - c).dot(normal) >= 0) {
      return false;
    }
  }
  return true;
}

// Ear clipping (G. Meisters, "Polygons have ears", 1975). If a polygon has no ear, because it is
// warped or crosses itself, any corner is cut; later checks examine the result. Above this size the
// search would take too long, and the polygon is treated as convex.
constexpr std::size_t most_searched = 128;

void split(std::span<const Index> polygon, const std::vector<Vec3>& x,
           std::vector<Triangle>& triangles) {
  std::vector<Index> left(polygon.begin(), polygon.end());
  const Vec3 normal = newell_normal(polygon, x);
  while (left.size() > 3) {
    std::size_t ear = 1;
    if (left.size() <= most_searched) {
      for (std::size_t i = 0; i < left.size(); ++i) {
        if (!is_ear(left, i, normal, x)) continue;
        ear = i;
        break;
      }
    }
    const std::size_t n = left.size();
    triangles.push_back({left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  triangles.push_back({left[0], left[1], left[2]});
}

}  // namespace

SurfaceSoup PolygonList::triangulate(std::vector<Vec3> nodes, std::int64_t first_id,
                                     const std::string& file) const {
  const Location where{file, 0, 0};
  require_indexable(nodes.size(), "vertices", file);
  require_indexable(corners_.size(), "corners of faces", file);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].cwiseAbs().maxCoeff() <= largest_coordinate && !nodes[i].hasNaN()) continue;
    throw Error(
        ErrorKind::input,
        fmt::format("vertex {} is ({}, {}, {}); finite coordinates up to 1e50 were expected",
                    static_cast<std::int64_t>(i) + first_id, nodes[i].x(), nodes[i].y(),
                    nodes[i].z()),
        "correct it, or export the surface again", where);
  }
  if (starts_.empty()) {
    throw Error(ErrorKind::input, "has no faces: these are points or lines, not a surface",
                "export the surface with its triangles", where);
  }
  SurfaceSoup soup;
  soup.polygons = starts_.size();
  const auto count = static_cast<std::int64_t>(nodes.size());
  std::vector<Index> polygon;
  for (std::size_t f = 0; f < starts_.size(); ++f) {
    const std::size_t end = f + 1 < starts_.size() ? starts_[f + 1] : corners_.size();
    polygon.clear();
    for (std::size_t i = starts_[f]; i < end; ++i) {
      if (corners_[i] < 0 || corners_[i] >= count) {
        throw Error(ErrorKind::input,
                    fmt::format("face {} names vertex {}; the file has vertices {} to {}", f + 1,
                                corners_[i] + first_id, first_id, count - 1 + first_id),
                    "correct the id, or export the surface again", where);
      }
      polygon.push_back(static_cast<Index>(corners_[i]));
    }
    if (polygon.size() < 3) {
      throw Error(ErrorKind::input,
                  fmt::format("face {} has {} corner{}; at least 3 were expected", f + 1,
                              polygon.size(), polygon.size() == 1 ? "" : "s"),
                  "export the surface as triangles", where);
    }
    if (polygon.size() == 3) {
      soup.triangles.push_back({polygon[0], polygon[1], polygon[2]});
    } else {
      split(polygon, nodes, soup.triangles);
    }
  }
  soup.nodes = std::move(nodes);
  return soup;
}

const std::vector<std::string>& surface_endings() {
  static const std::vector<std::string> endings = {".off", ".obj", ".stl", ".ply"};
  return endings;
}

bool is_surface_name(const fs::path& path) {
  const std::vector<std::string>& endings = surface_endings();
  return std::find(endings.begin(), endings.end(), lower_extension(path)) != endings.end();
}

SurfaceSoup read_surface(const fs::path& path) {
  const std::string ending = lower_extension(path);
  const std::string file = path.string();
  if (ending == ".off") return parse_off(read_file(path), file);
  if (ending == ".obj") return parse_obj(read_file(path), file);
  if (ending == ".stl") return parse_stl(read_file(path), file);
  if (ending == ".ply") return parse_ply(read_file(path), file);
  throw Error(ErrorKind::input,
              ending.empty() ? std::string("has no ending that says its format")
                             : fmt::format("has the unknown ending \"{}\"", ending),
              fmt::format("surfaces end with {}", fmt::join(surface_endings(), " ")), {file});
}

}  // namespace sinew::io
