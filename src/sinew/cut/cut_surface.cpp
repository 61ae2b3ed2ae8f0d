#include "sinew/cut/cut_surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sinew/base/error.h"
#include "sinew/base/random.h"

namespace sinew {
namespace {

__extension__ using Wide = __int128;  // of GCC and Clang

constexpr int grid_bits = 39;
constexpr double jitter_cells = 0x1p14;
constexpr double farthest = 1e6;  // sides of the box

using Difference = std::array<std::int64_t, 3>;

Difference difference(const std::array<std::int64_t, 3>& a, const std::array<std::int64_t, 3>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

// Six times the volume of the tet a b c d, exact: differences have 40 bits, minors 81, the sum 123.
Wide volume(const std::array<std::int64_t, 3>& a, const std::array<std::int64_t, 3>& b,
            const std::array<std::int64_t, 3>& c, const std::array<std::int64_t, 3>& d) {
  const Difference u = difference(b, a), v = difference(c, a), w = difference(d, a);
  const auto minor = [&](int i, int j) {
    const auto p = static_cast<std::size_t>(i), q = static_cast<std::size_t>(j);
    return static_cast<Wide>(u[p]) * v[q] - static_cast<Wide>(u[q]) * v[p];
  };
  return minor(1, 2) * w[0] + minor(2, 0) * w[1] + minor(0, 1) * w[2];
}

// Equal points move alike: triangles that share a vertex by value keep sharing it.
std::array<std::int64_t, 3> moved(std::array<std::int64_t, 3> g) {
  std::uint64_t seed = 0;
  for (const std::int64_t c : g)
    seed = seed * 0x9e3779b97f4a7c15ULL + static_cast<std::uint64_t>(c);
  for (std::size_t i = 0; i < 3; ++i)
    g[i] += std::llround((2.0 * random_number(seed + i) - 1.0) * jitter_cells);
  return g;
}

}  // namespace

CutTriangles disc_surface(const Vec3& center, const Vec3& normal, double radius, Index corners) {
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
  CutTriangles out;
  out.vertices.push_back(center);
  for (Index i = 0; i < corners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / corners;
    out.vertices.push_back(center + radius * (std::cos(angle) * u + std::sin(angle) * v));
    out.triangles.push_back({0, 1 + i, 1 + (i + 1) % corners});
  }
  return out;
}

CutSurface::CutSurface(const CutTriangles& surface, const Box& around) {
  const double side = std::max((around.hi - around.lo).maxCoeff(), 1e-300);
  Box all = around.grown(side);
  for (const Vec3& v : surface.vertices) {
    if (!v.allFinite())
      throw Error(ErrorKind::input, "a vertex of the cut is not a finite point",
                  "give finite coordinates in metres");
    all.add(v);
  }
  const double longest = (all.hi - all.lo).maxCoeff();
  if (!(longest <= farthest * side))
    throw Error(ErrorKind::input, "the cut reaches more than a million body lengths away",
                "check its unit; coordinates are in metres");
  origin_ = all.lo - Vec3::Constant(longest / 64.0);
  cells_ = std::ldexp(1.0, grid_bits) / (longest * (1.0 + 1.0 / 16.0));
  for (const Vec3& v : surface.vertices) vertices_.push_back(moved(rounded(v)));
  std::vector<Vec3> centres;
  std::vector<Box> boxes;
  for (const Triangle& t : surface.triangles) {
    for (const Index corner : t) {
      if (corner < 0 || uz(corner) >= surface.vertices.size())
        throw Error(ErrorKind::input, "a triangle of the cut has a vertex that does not exist",
                    "number the vertices from 0");
    }
    const Vec3 &a = surface.vertices[uz(t[0])], &b = surface.vertices[uz(t[1])],
               &c = surface.vertices[uz(t[2])];
    const Vec3 n = (b - a).cross(c - a);
    if (!(n.norm() > 0.0)) continue;
    triangles_.push_back(t);
    normal_.push_back(n.normalized());
    centres.push_back((a + b + c) / 3.0);
    Box box;
    for (const Vec3& x : {a, b, c}) box.add(x);
    boxes.push_back(box.grown(4.0 * jitter_cells / cells_));
  }
  tree_ = BoxTree(centres);
  tree_.refit(boxes);
}

CutSurface::GridPoint CutSurface::rounded(const Vec3& x) const {
  GridPoint g;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Index>(i);
    g[i] = std::llround((x[k] - origin_[k]) * cells_);
  }
  return g;
}

bool CutSurface::near(const Box& box) const {
  near_.clear();
  tree_.find(box, near_);
  return !near_.empty();
}

void CutSurface::cross(const Vec3& p, const Vec3& q, std::vector<Crossing>& found) const {
  found.clear();
  Box box;
  box.add(p);
  box.add(q);
  if (!near(box)) return;
  const GridPoint gp = rounded(p), gq = rounded(q);
  for (const Index t : near_) {
    const Triangle& corner = triangles_[uz(t)];
    const GridPoint &a = vertices_[uz(corner[0])], &b = vertices_[uz(corner[1])],
                    &c = vertices_[uz(corner[2])];
    const Wide from = volume(a, b, c, gp), to = volume(a, b, c, gq);
    if ((from >= 0) == (to >= 0)) continue;
    // An edge of two triangles is passed on the same side for both, also where the volume is 0: its
    // vertices are taken in a fixed order.
    const auto left = [&](const GridPoint& x, const GridPoint& y) {
      return x < y ? volume(gp, gq, x, y) >= 0 : volume(gp, gq, y, x) < 0;
    };
    const bool first = left(a, b);
    if (left(b, c) != first || left(c, a) != first) continue;
    const double before = std::abs(static_cast<double>(from));
    const double after = std::abs(static_cast<double>(to));
    found.push_back({before / (before + after), t});
  }
  std::sort(found.begin(), found.end(), [](const Crossing& a, const Crossing& b) {
    return a.at < b.at || (a.at == b.at && a.triangle < b.triangle);
  });
}

bool CutSurface::separates(const Vec3& p, const Vec3& q) const {
  std::vector<Crossing> found;
  cross(p, q, found);
  return found.size() % 2 == 1;
}

}  // namespace sinew
