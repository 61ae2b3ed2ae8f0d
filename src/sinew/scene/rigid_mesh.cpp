#include "sinew/scene/rigid_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "sinew/io/surface_file.h"
#include "sinew/scene/place.h"

namespace sinew {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse_mesh(const std::string& table, const Location& where,
                              const std::string& what, const std::string& remedy) {
  throw Error(ErrorKind::input, fmt::format("the mesh of {} {}", table, what), remedy, where);
}

[[noreturn]] void refuse(const SceneObstacle& o, const std::string& what,
                         const std::string& remedy) {
  refuse_mesh(fmt::format("[obstacle.{}]", o.name), o.mesh_where, what, remedy);
}

io::SurfaceSoup read_soup(const Scene& scene, const std::string& mesh, const std::string& table,
                          const Location& where) {
  if (const auto given = scene.given.obstacles.find(mesh); given != scene.given.obstacles.end())
    return *given->second;
  const fs::path path = fs::path(scene.base) / mesh;
  if (!io::is_surface_name(path))
    refuse_mesh(table, where, fmt::format("is no surface: {}", mesh),
                "name a file .off .obj .stl .ply; a tet mesh is a body, and a body can be pinned "
                "whole");
  std::error_code failed;
  if (!fs::exists(path, failed))
    refuse_mesh(table, where, fmt::format("is not there: {}", path.lexically_normal().string()),
                "mesh paths start from the scene file's folder");
  return io::read_surface(path);
}

// Merges coincident vertices: STL files list every corner separately.
void weld(const io::SurfaceSoup& soup, RigidMesh& mesh) {
  std::map<std::array<double, 3>, Index> known;
  std::vector<Index> as;
  for (const Vec3& x : soup.nodes) {
    const auto [at, added] =
        known.try_emplace({x.x(), x.y(), x.z()}, static_cast<Index>(mesh.vertices.size()));
    if (added) mesh.vertices.push_back(x);
    as.push_back(at->second);
  }
  for (const Triangle& t : soup.triangles) {
    const Triangle u = {as[uz(t[0])], as[uz(t[1])], as[uz(t[2])]};
    const Vec3& a = mesh.vertices[uz(u[0])];
    const Vec3 area = (mesh.vertices[uz(u[1])] - a).cross(mesh.vertices[uz(u[2])] - a);
    if (area.squaredNorm() > 0.0) mesh.triangles.push_back(u);
  }
}

// Drops vertices that no triangle uses.
void drop_loose_vertices(RigidMesh& mesh) {
  std::vector<Index> as(mesh.vertices.size(), -1);
  std::vector<Vec3> kept;
  for (Triangle& t : mesh.triangles) {
    for (Index& corner : t) {
      if (as[uz(corner)] < 0) {
        as[uz(corner)] = static_cast<Index>(kept.size());
        kept.push_back(mesh.vertices[uz(corner)]);
      }
      corner = as[uz(corner)];
    }
  }
  mesh.vertices = std::move(kept);
}

// If two triangles run along a common edge in the same direction, their outsides are on different
// sides.
void check_winding(const SceneObstacle& o, const RigidMesh& mesh) {
  std::set<Edge> directed;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t e = 0; e < 3; ++e)
      if (!directed.insert({t[e], t[(e + 1) % 3]}).second)
        refuse(o, "is not wound the same way all over: which side is outside cannot be told",
               "orient its faces consistently in a mesh editor");
}

}  // namespace

RigidMesh read_rigid_mesh(const Scene& scene, const SceneObstacle& o) {
  RigidMesh mesh;
  weld(read_soup(scene, o.mesh, fmt::format("[obstacle.{}]", o.name), o.mesh_where), mesh);
  if (mesh.triangles.empty()) refuse(o, "has no triangle with an area", "check the file");
  drop_loose_vertices(mesh);
  check_winding(o, mesh);
  if (o.flip)
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  const Mat3 turn = o.rotation.toRotationMatrix();
  for (Vec3& x : mesh.vertices) {
    x = o.center + turn * (o.scale * x);
    if (!(x.cwiseAbs().maxCoeff() < largest_place))
      refuse(o, "is placed beyond 1e9 m", "check scale and center; they are in metres");
  }
  return mesh;
}

CutTriangles read_cut_mesh(const Scene& scene, const SceneCut& cut) {
  io::SurfaceSoup soup =
      read_soup(scene, cut.mesh, fmt::format("[cut.{}]", cut.name), cut.mesh_where);
  for (Vec3& x : soup.nodes) x *= cut.scale;
  return {std::move(soup.nodes), std::move(soup.triangles)};
}

}  // namespace sinew
