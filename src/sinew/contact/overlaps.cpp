#include "sinew/contact/overlaps.h"

#include <algorithm>
#include <cmath>

#include "sinew/contact/box_tree.h"
#include "sinew/contact/nearest.h"
#include "sinew/mesh/tet_mesh.h"

namespace sinew {
namespace {

// The sign of the volume does not matter: an inverted tet still contains the points between its
// corners.
bool inside(const Vec3& p, const std::vector<Vec3>& x, const Tet& t) {
  const Vec3 &a = x[uz(t[0])], &b = x[uz(t[1])], &c = x[uz(t[2])], &d = x[uz(t[3])];
  const double all = signed_volume(a, b, c, d);
  if (!(all != 0.0)) return false;
  return signed_volume(p, b, c, d) / all >= 0.0 && signed_volume(a, p, c, d) / all >= 0.0 &&
         signed_volume(a, b, p, d) / all >= 0.0 && signed_volume(a, b, c, p) / all >= 0.0;
}

BoxTree tree_of(const std::vector<Box>& boxes) {
  std::vector<Vec3> centres;
  for (const Box& b : boxes) centres.push_back(0.5 * (b.lo + b.hi));
  BoxTree tree(centres);
  if (!tree.empty()) tree.refit(boxes);
  return tree;
}

double distance_to_surface(const Vec3& p, const std::vector<Vec3>& x, const ContactSurface& s,
                           Range triangles) {
  double least2 = std::numeric_limits<double>::infinity();
  for (Index t = triangles.begin; t < triangles.end; ++t) {
    const Triangle& tri = s.triangles[uz(t)];
    least2 = std::min(
        least2, nearest_on_triangle(p, x[uz(tri[0])], x[uz(tri[1])], x[uz(tri[2])]).distance2);
  }
  return std::sqrt(least2);
}

// The parts of the owners of a body, which follow each other.
Range of_body(const std::vector<Range>& ranges, const ContactSurface& s, Index body) {
  const Range owners = s.body_owners[uz(body)];
  return {ranges[uz(owners.begin)].begin, ranges[uz(owners.end - 1)].end};
}

// Bodies that coincide have all their surface nodes on each other's surface: the middles of the
// tets of a, or of a sample of them, show how deep they are.
void look_inside(const Model& model, const std::vector<Vec3>& x, const BoxTree& tree,
                 Overlap& overlap) {
  constexpr Index most = 500;
  const ContactSurface& s = model.surface;
  const Body &a = model.bodies[uz(overlap.a)], &b = model.bodies[uz(overlap.b)];
  std::vector<Index> near;
  for (Index t = a.tets.begin; t < a.tets.end; t += 1 + a.tets.size() / most) {
    const Tet& tet = model.tets[uz(t)];
    const Vec3 middle = 0.25 * (x[uz(tet[0])] + x[uz(tet[1])] + x[uz(tet[2])] + x[uz(tet[3])]);
    Box at;
    at.add(middle);
    near.clear();
    tree.find(at, near);
    const bool in = std::any_of(near.begin(), near.end(), [&](Index k) {
      return inside(middle, x, model.tets[uz(b.tets.begin + k)]);
    });
    if (!in) continue;
    const double depth =
        distance_to_surface(middle, x, s, of_body(s.owner_triangles, s, overlap.b));
    if (depth <= overlap.depth) continue;
    overlap.depth = depth;
    overlap.deepest = tet[0];
  }
}

}  // namespace

std::vector<Overlap> find_overlaps(const Model& model, const std::vector<Vec3>& x,
                                   double tolerance) {
  const ContactSurface& s = model.surface;
  std::vector<Overlap> overlaps;
  if (s.empty()) return overlaps;
  std::vector<BoxTree> trees;
  std::vector<Box> bounds;
  for (const Body& body : model.bodies) {
    std::vector<Box> boxes;
    Box all;
    for (Index t = body.tets.begin; t < body.tets.end; ++t) {
      boxes.push_back(box_around(model.tets[uz(t)], x));
      all.add(boxes.back());
    }
    trees.push_back(tree_of(boxes));
    bounds.push_back(all);
  }
  std::vector<Index> near;
  for (Index a = 0; a < static_cast<Index>(s.body_owners.size()); ++a) {
    for (Index b = 0; b < static_cast<Index>(s.body_owners.size()); ++b) {
      if (a == b || !bounds[uz(a)].overlaps(bounds[uz(b)])) continue;
      const Index first = model.bodies[uz(b)].tets.begin;
      Overlap overlap;
      overlap.a = a;
      overlap.b = b;
      const Range slots = of_body(s.owner_nodes, s, a);
      for (Index slot = slots.begin; slot < slots.end; ++slot) {
        const Index node = s.nodes[uz(slot)];
        near.clear();
        trees[uz(b)].find(box_around(std::array<Index, 1>{node}, x), near);
        const bool in = std::any_of(near.begin(), near.end(), [&](Index t) {
          return inside(x[uz(node)], x, model.tets[uz(first + t)]);
        });
        if (!in) continue;
        const double depth =
            distance_to_surface(x[uz(node)], x, s, of_body(s.owner_triangles, s, b));
        if (depth < tolerance) continue;
        ++overlap.nodes;
        if (overlap.deepest < 0 || depth > overlap.depth) {
          overlap.depth = depth;
          overlap.deepest = node;
        }
      }
      const double size = (bounds[uz(b)].hi - bounds[uz(b)].lo).norm();
      if (overlap.nodes > 0 && overlap.depth < 1e-6 * size)
        look_inside(model, x, trees[uz(b)], overlap);
      if (overlap.nodes > 0) overlaps.push_back(overlap);
    }
  }
  return overlaps;
}

}  // namespace sinew
