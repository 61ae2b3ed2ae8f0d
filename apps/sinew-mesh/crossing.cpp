// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Box_intersection_d/Box_with_info_d.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <set>

#include "examine.h"

namespace sinew::mesher {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Box = CGAL::Box_intersection_d::Box_with_info_d<double, 3, Index>;

Point point(const Vec3& x) {
  return {x.x(), x.y(), x.z()};
}

// Whether two triangles meet in more than their common nodes.
class Meet {
 public:
  explicit Meet(const io::SurfaceSoup& surface) : s_(surface) {}

  bool operator()(Index i, Index j) const {
    Triangle a = s_.triangles[uz(i)], b = s_.triangles[uz(j)];
    // Moves common nodes to the front of both.
    std::size_t common = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto at = std::find(b.begin() + static_cast<std::ptrdiff_t>(common), b.end(), a[k]);
      if (at == b.end()) continue;
      std::iter_swap(at, b.begin() + static_cast<std::ptrdiff_t>(common));
      std::swap(a[k], a[common]);
      ++common;
    }
    const auto p = [&](Index n) { return point(s_.nodes[uz(n)]); };
    const Kernel::Triangle_3 s(p(a[0]), p(a[1]), p(a[2])), t(p(b[0]), p(b[1]), p(b[2]));
    if (common == 0) return CGAL::do_intersect(s, t);
    if (common == 1) {  // the sides opposite the common node
      return CGAL::do_intersect(s, Kernel::Segment_3(p(b[1]), p(b[2]))) ||
             CGAL::do_intersect(t, Kernel::Segment_3(p(a[1]), p(a[2])));
    }
    // With a common edge: they overlap if they are folded together.
    return CGAL::coplanar(p(a[0]), p(a[1]), p(a[2]), p(b[2])) &&
           CGAL::coplanar_orientation(p(a[0]), p(a[1]), p(a[2]), p(b[2])) == CGAL::POSITIVE;
  }

 private:
  const io::SurfaceSoup& s_;
};

}  // namespace

Crossings find_crossings(const io::SurfaceSoup& surface, const std::vector<Index>& part_of) {
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    const Triangle& t = surface.triangles[i];
    const Vec3 &a = surface.nodes[uz(t[0])], &b = surface.nodes[uz(t[1])],
               &c = surface.nodes[uz(t[2])];
    if (is_flat(a, b, c)) continue;
    boxes.emplace_back(point(a).bbox() + point(b).bbox() + point(c).bbox(), static_cast<Index>(i));
  }
  const Meet meet(surface);
  Crossings found;
  Index first = -1;
  std::set<std::array<Index, 2>> crossing;
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& l, const Box& r) {
    const Index i = std::min(l.info(), r.info()), j = std::max(l.info(), r.info());
    if (!meet(i, j)) return;
    ++found.pairs;
    const std::array<Index, 2> between = {std::min(part_of[uz(i)], part_of[uz(j)]),
                                          std::max(part_of[uz(i)], part_of[uz(j)])};
    if (between[0] == between[1]) {
      ++found.within_parts;
    } else {
      crossing.insert(between);
    }
    if (first >= 0 && first <= i) return;
    first = i;
    const Triangle& t = surface.triangles[uz(i)];
    found.first = (surface.nodes[uz(t[0])] + surface.nodes[uz(t[1])] + surface.nodes[uz(t[2])]) / 3;
  });
  found.parts.assign(crossing.begin(), crossing.end());
  return found;
}

}  // namespace sinew::mesher
