// Random cuts of meshes, for tests.
#pragma once

#include <cmath>
#include <vector>

#include "sinew/base/random.h"
#include "sinew/contact/box_tree.h"
#include "sinew/cut/cut_mesh.h"
#include "sinew/mesh/surface.h"

namespace sinew::test {

// A flat disc, as a fan of 12 triangles.
inline CutTriangles disc(const Vec3& center, const Vec3& normal, double radius) {
  const Vec3 u = normal.unitOrthogonal(), v = normal.normalized().cross(u);
  CutTriangles out;
  out.vertices.push_back(center);
  for (Index i = 0; i < 12; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 12.0;
    out.vertices.push_back(center + radius * (std::cos(angle) * u + std::sin(angle) * v));
    out.triangles.push_back({0, 1 + i, 1 + (i + 1) % 12});
  }
  return out;
}

// A mesh that is cut again and again.
struct CutPiece {
  std::vector<Vec3> nodes;
  std::vector<Tet> tets;
  std::vector<double> size;

  explicit CutPiece(const TetMesh& mesh)
      : nodes(mesh.nodes), tets(mesh.tets), size(size_at_nodes(mesh.nodes, mesh.tets)) {}

  Box bounds() const {
    Box box;
    for (const Vec3& x : nodes) box.add(x);
    return box;
  }
  BodyCut plan(const CutTriangles& surface) const {
    return plan_cut({nodes, nodes, tets, size}, CutSurface(surface, bounds()));
  }
  // Whether anything was cut.
  bool cut(const CutTriangles& surface) {
    const BodyCut planned = plan(surface);
    MeshAfterCut after = cut_mesh(nodes, tets, planned);
    after.extend(size);
    nodes = std::move(after.nodes);
    tets = std::move(after.tets);
    return !planned.empty();
  }
  double volume() const {
    double sum = 0.0;
    for (const Tet& t : tets) sum += signed_volume(nodes, t);
    return sum;
  }
  Components parts() const {
    return connected_components(std::span<const Tet>(tets), static_cast<Index>(nodes.size()));
  }
};

// The n-th random disc near the middle of the box: every second one cuts all through.
inline CutTriangles random_disc(std::uint64_t n, const Box& box) {
  const Vec3 span = box.hi - box.lo;
  const Vec3 center = box.lo + span.cwiseProduct(Vec3::Constant(0.25) + 0.5 * random_point(3 * n));
  const Vec3 normal = random_point(3 * n + 1) - Vec3::Constant(0.5);
  const double radius = n % 2 == 0 ? 3.0 : 0.1 + 0.4 * random_number(90001 + n);
  return disc(center, normal, radius * span.maxCoeff());
}

}  // namespace sinew::test
