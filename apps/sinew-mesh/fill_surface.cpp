// SPDX-License-Identifier: GPL-3.0-or-later
#include "quiet_cgal.h"  // first

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polyhedral_mesh_domain_with_features_3.h>
#include <CGAL/Random.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "mesh3.h"
#include "sinew/mesh/surface.h"

namespace sinew::mesher {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Surface = CGAL::Surface_mesh<Point>;
using Domain = CGAL::Polyhedral_mesh_domain_with_features_3<Kernel, Surface>;

constexpr std::size_t start_points = 24;  // of each part, enough for its rough shape

Surface to_mesh(const io::SurfaceSoup& soup, const Vec3& centre, double unit) {
  std::vector<Point> points;
  for (const Vec3& x : soup.nodes) {
    const Vec3 y = (x - centre) / unit;
    points.emplace_back(y.x(), y.y(), y.z());
  }
  std::vector<std::vector<std::size_t>> polygons;
  for (const Triangle& t : soup.triangles) polygons.push_back({uz(t[0]), uz(t[1]), uz(t[2])});
  pmp::orient_polygon_soup(points, polygons);  // doubles nodes where the surface touches itself
  Surface mesh;
  pmp::polygon_soup_to_polygon_mesh(points, polygons, mesh);
  return mesh;
}

// Triangles of one part at large distances: each is the farthest from those before it.
std::vector<Index> spread(const std::vector<Index>& triangles, const std::vector<Vec3>& middle) {
  std::vector<Index> chosen = {triangles.front()};
  std::vector<double> distance(triangles.size(), std::numeric_limits<double>::infinity());
  while (chosen.size() < std::min(start_points, triangles.size())) {
    const Vec3& last = middle[uz(chosen.back())];
    std::size_t farthest = 0;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      distance[i] = std::min(distance[i], (middle[uz(triangles[i])] - last).squaredNorm());
      if (distance[i] > distance[farthest]) farthest = i;
    }
    if (!(distance[farthest] > 0)) break;
    chosen.push_back(triangles[farthest]);
  }
  return chosen;
}

}  // namespace

TetMesh fill_surface(const io::SurfaceSoup& soup, Target target, Progress& progress) {
  progress.phase("preparing the surface");
  CGAL::get_default_random() = CGAL::Random(0);  // the same mesh every time
  CGAL::Random random(0);

  // The mesh is made about the origin with an extent near 1, because some of CGAL's tolerances are
  // absolute.
  Vec3 low = soup.nodes[uz(soup.triangles[0][0])], high = low;
  for (const Triangle& t : soup.triangles) {
    for (const Index n : t) {
      low = low.cwiseMin(soup.nodes[uz(n)]);
      high = high.cwiseMax(soup.nodes[uz(n)]);
    }
  }
  const Vec3 centre = 0.5 * (low + high);
  const double unit = std::exp2(std::round(std::log2((high - low).norm())));
  target.size /= unit;
  target.distance /= unit;

  const Surface surface = to_mesh(soup, centre, unit);
  Domain domain(surface, &random);
  if (target.sharp) domain.detect_features(target.sharp_angle);

  // CGAL's own method shoots a few rays from the middle and misses small parts.
  std::vector<std::pair<Point, Domain::Index>> start;
  const Components parts =
      connected_components(soup.triangles, static_cast<Index>(soup.nodes.size()));
  // Points within triangles at no special place, because CGAL fails if two nodes coincide.
  std::vector<std::vector<Index>> triangles(uz(parts.count));
  std::vector<Vec3> middle;
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    const Triangle& corners = soup.triangles[t];
    triangles[uz(parts.of[t])].push_back(static_cast<Index>(t));
    middle.push_back((0.31 * soup.nodes[uz(corners[0])] + 0.36 * soup.nodes[uz(corners[1])] +
                      0.33 * soup.nodes[uz(corners[2])] - centre) /
                     unit);
  }
  const auto patch = Domain::Surface_patch_index(1);
  for (const std::vector<Index>& part : triangles) {
    for (const Index t : spread(part, middle)) {
      const Vec3& y = middle[uz(t)];
      start.emplace_back(Point(y.x(), y.y(), y.z()), domain.index_from_surface_patch_index(patch));
    }
  }

  const auto label = [&](const auto& c3t3, const auto& facet) {
    return target.sharp ? static_cast<int>(c3t3.surface_patch_index(facet)) : 1;
  };
  TetMesh mesh = fill<Domain, Domain::Corner_index, Domain::Curve_index>(domain, start, target,
                                                                         label, progress);
  std::fill(mesh.tet_label.begin(), mesh.tet_label.end(), 1);
  for (Vec3& x : mesh.nodes) x = unit * x + centre;
  return mesh;
}

}  // namespace sinew::mesher
