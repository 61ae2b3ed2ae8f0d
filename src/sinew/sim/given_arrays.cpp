// The arrays of a scene that is built in code.
#include <fmt/format.h>

#include <utility>

#include "sinew/base/error.h"
#include "sinew/io/surface_file.h"
#include "sinew/mesh/tet_mesh.h"
#include "sinew/sim/describe.h"

namespace sinew::sim {
namespace {

[[noreturn]] void refuse(std::string message, std::string remedy, const std::string& place) {
  throw Error(ErrorKind::input, std::move(message), std::move(remedy), {place, 0, 0});
}

constexpr std::size_t most_nodes = 100'000'000;

void check_length(const std::string& of, const char* array, std::size_t length, const char* of_what,
                  std::size_t expected, const std::string& place) {
  if (length == 0 || length == expected) return;
  refuse(fmt::format("the arrays of {} have {} {} for {} {}", of, length, array, expected, of_what),
         fmt::format("give one for each of the {}, or none", of_what), place);
}

std::vector<Vec3> places_of(const std::vector<Point>& points) {
  std::vector<Vec3> out;
  out.reserve(points.size());
  for (const Point& p : points) out.emplace_back(p[0], p[1], p[2]);
  return out;
}

void refuse_two_sources(const std::string& of, const std::string& mesh, bool arrays,
                        const std::string& place) {
  if (!arrays || mesh.empty()) return;
  refuse(fmt::format("{} has both a mesh file and arrays", of), "remove one of them", place);
}

std::shared_ptr<const io::SurfaceSoup> soup_of(const SurfaceArrays& arrays, const std::string& of,
                                               const std::string& place) {
  auto soup = std::make_shared<io::SurfaceSoup>();
  soup->nodes = places_of(arrays.nodes);
  soup->triangles = arrays.triangles;
  soup->polygons = arrays.triangles.size();
  const auto count = static_cast<std::int64_t>(soup->nodes.size());
  for (std::size_t i = 0; i < soup->nodes.size(); ++i)
    if (!soup->nodes[i].allFinite())
      refuse(fmt::format("node {} of the arrays of {} is not finite", i, of),
             "give x, y, z in metres", place);
  for (std::size_t t = 0; t < soup->triangles.size(); ++t)
    for (const Index node : soup->triangles[t])
      if (node < 0 || node >= count)
        refuse(fmt::format("triangle {} of the arrays of {} names node {}, which is not there", t,
                           of, node),
               fmt::format("node ids are from 0 to {}", count - 1), place);
  return soup;
}

}  // namespace

std::string memory_name(const std::string& name) {
  return "memory:" + name;
}

void keep_arrays(const BodyDescription& b, const std::string& place, GivenMeshes& given) {
  const std::string of = fmt::format("[body.{}]", b.name);
  refuse_two_sources(of, b.mesh, b.arrays.has_value(), place);
  if (!b.arrays) return;
  const MeshArrays& a = *b.arrays;
  if (a.nodes.empty() || a.tets.empty())
    refuse(fmt::format("the arrays of {} have {} nodes and {} tets", of, a.nodes.size(),
                       a.tets.size()),
           "a body has four nodes and one tet at least", place);
  if (a.nodes.size() > most_nodes || a.tets.size() > most_nodes)
    refuse(fmt::format("the arrays of {} have {} nodes and {} tets", of, a.nodes.size(),
                       a.tets.size()),
           fmt::format("at most {} of each", most_nodes), place);
  check_length(of, "tet labels", a.tet_labels.size(), "tets", a.tets.size(), place);
  check_length(of, "node labels", a.node_labels.size(), "nodes", a.nodes.size(), place);
  if (a.faces.size() != a.face_labels.size())
    refuse(fmt::format("the arrays of {} have {} face labels for {} faces", of,
                       a.face_labels.size(), a.faces.size()),
           "give one for each of the faces", place);
  given.bodies[memory_name(b.name)] = std::make_shared<const TetMesh>(
      TetMesh{places_of(a.nodes), a.tets, a.tet_labels, a.node_labels, a.faces, a.face_labels});
}

void keep_arrays(const ObstacleDescription& o, const std::string& place, GivenMeshes& given) {
  const std::string of = fmt::format("[obstacle.{}]", o.name);
  refuse_two_sources(of, o.mesh, o.arrays.has_value(), place);
  if (o.arrays) given.obstacles[memory_name(o.name)] = soup_of(*o.arrays, of, place);
}

void keep_arrays(const CutDescription& c, const std::string& place, GivenMeshes& given) {
  const std::string of = fmt::format("[cut.{}]", c.name);
  refuse_two_sources(of, c.mesh, c.arrays.has_value(), place);
  if (c.arrays) given.obstacles[memory_name("cut " + c.name)] = soup_of(*c.arrays, of, place);
}

}  // namespace sinew::sim
