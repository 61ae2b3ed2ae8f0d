// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_self_intersections.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "examine.h"
#include "patches.h"

namespace sinew::mesher {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;

// The mesh of the chosen triangles; an empty choice means all.
Mesh to_mesh(const io::SurfaceSoup& soup, const std::vector<bool>& chosen = {}) {
  std::vector<Point> points;
  for (const Vec3& x : soup.nodes) points.emplace_back(x.x(), x.y(), x.z());
  std::vector<std::vector<std::size_t>> polygons;
  for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
    const Triangle& t = soup.triangles[i];
    if (chosen.empty() || chosen[i]) polygons.push_back({uz(t[0]), uz(t[1]), uz(t[2])});
  }
  pmp::orient_polygon_soup(points, polygons);
  Mesh mesh;
  pmp::polygon_soup_to_polygon_mesh(points, polygons, mesh);
  return mesh;
}

void append(io::SurfaceSoup& soup, const Mesh& mesh) {
  std::map<Mesh::Vertex_index, Index> number;
  const auto node = [&](Mesh::Vertex_index v) {
    const auto [entry, added] = number.emplace(v, static_cast<Index>(soup.nodes.size()));
    if (added) {
      const Point& p = mesh.point(v);
      soup.nodes.emplace_back(p.x(), p.y(), p.z());
    }
    return entry->second;
  };
  for (const Mesh::Face_index f : mesh.faces()) {
    Triangle t{};
    std::size_t k = 0;
    for (const Mesh::Vertex_index v : CGAL::vertices_around_face(mesh.halfedge(f), mesh)) {
      if (k < 3) t[k++] = node(v);
    }
    soup.triangles.push_back(t);
  }
}

// Fills every hole with triangles as small as those around it, as flat as the rim permits.
io::SurfaceSoup fill_holes(const io::SurfaceSoup& soup, std::vector<std::string>& log) {
  Mesh mesh = to_mesh(soup);
  pmp::stitch_borders(mesh);
  std::vector<Mesh::Halfedge_index> holes;
  pmp::extract_boundary_cycles(mesh, std::back_inserter(holes));
  std::size_t filled = 0;
  for (const Mesh::Halfedge_index hole : holes) {
    std::vector<Mesh::Face_index> faces;
    std::vector<Mesh::Vertex_index> vertices;
    pmp::triangulate_and_refine_hole(mesh, hole, std::back_inserter(faces),
                                     std::back_inserter(vertices));
    filled += !faces.empty();
  }
  if (filled > 0) log.push_back(fmt::format("filled {} hole{}", filled, filled == 1 ? "" : "s"));
  if (filled < holes.size()) {
    log.push_back(
        fmt::format("could not fill {} of {} holes", holes.size() - filled, holes.size()));
  }
  io::SurfaceSoup out;
  append(out, mesh);
  return out;
}

// Cuts out where a part crosses itself and closes the cut.
io::SurfaceSoup cut_out(const Examination& e, std::vector<std::string>& log) {
  Mesh mesh = to_mesh(e.surface);
  pmp::experimental::remove_self_intersections(mesh, CGAL::parameters::preserve_genus(false));
  log.push_back("cut out where the surface crossed itself");
  io::SurfaceSoup out;
  append(out, mesh);
  return out;
}

// Unites parts that cross each other.
io::SurfaceSoup unite(const Examination& e, const Crossings& crossings,
                      std::vector<std::string>& log) {
  std::vector<Mesh> parts;
  for (std::size_t p = 0; p < e.parts.size(); ++p) {
    std::vector<bool> chosen(e.surface.triangles.size());
    for (std::size_t i = 0; i < chosen.size(); ++i) chosen[i] = uz(e.part_of[i]) == p;
    parts.push_back(to_mesh(e.surface, chosen));
  }
  std::vector<std::size_t> now(parts.size());  // index of the mesh that contains each part
  for (std::size_t p = 0; p < now.size(); ++p) now[p] = p;
  std::size_t done = 0, failed = 0;
  for (const auto& [a, b] : crossings.parts) {
    const std::size_t l = now[uz(a)], r = now[uz(b)];
    if (l == r) continue;
    Mesh joined;
    if (!pmp::corefine_and_compute_union(parts[l], parts[r], joined)) {
      ++failed;
      continue;
    }
    parts[l] = joined;
    parts[r].clear();
    for (std::size_t& n : now) {
      if (n == r) n = l;
    }
    ++done;
  }
  if (done > 0) log.push_back(fmt::format("united {} parts that crossed each other", done + 1));
  if (failed > 0) log.push_back(fmt::format("could not unite {} pairs of parts", failed));
  io::SurfaceSoup out;
  for (const Mesh& part : parts) append(out, part);
  return out;
}

}  // namespace

io::SurfaceSoup repair_surface(const Examination& examined, std::vector<std::string>& log) {
  Examination e = examined;
  if (e.find("open") || e.find("wall")) {
    e = examine(join_close_nodes(e, log));
  }
  if (e.find("wall")) e = examine(drop_walls(e, log));
  if (e.find("open")) e = examine(drop_scraps(e, log));
  if (e.find("open") && !e.find("not_orientable")) e = examine(fill_holes(e.surface, log));
  // A cut may create new crossings elsewhere, so there are a few rounds.
  for (int round = 0; round < 3 && e.find("crossing"); ++round) {
    const Crossings crossings = find_crossings(e.surface, e.part_of);
    if (crossings.within_parts == 0) {
      e = examine(unite(e, crossings, log));
    } else {
      e = examine(cut_out(e, log));
    }
    if (e.find("open")) e = examine(fill_holes(e.surface, log));
  }
  return e.surface;
}

}  // namespace sinew::mesher
