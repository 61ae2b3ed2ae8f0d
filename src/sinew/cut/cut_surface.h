// The surface of a cut: the triangles that a blade sweeps, and where segments cross them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sinew/base/vec.h"
#include "sinew/contact/box_tree.h"

namespace sinew {

// Triangles in the coordinates of the mesh that is cut [m]. They need not be closed, connected or
// oriented.
struct CutTriangles {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
};

// A disc as a fan of triangles; normal: of length 1.
CutTriangles disc_surface(const Vec3& center, const Vec3& normal, double radius, Index corners);

// Crossings are decided by exact arithmetic: coordinates are rounded to a grid of 2^39 cells along
// the longest side of everything, where the sign of a tet's volume is an integer of less than 128
// bits. Thus a segment does not slip through between two triangles that share an edge. Vertices
// are moved by up to 2^-25 of that side, at random but always the same, so that a mesh whose nodes
// lie on the surface is cut like any other.
class CutSurface {
 public:
  // `around`: a box around the segments that are tested. Throws Error(input) if a vertex is not
  // finite or more than a million of the box's sides away.
  CutSurface(const CutTriangles& surface, const Box& around);

  struct Crossing {
    double at = 0.0;  // share of the segment from p to q, in (0, 1)
    Index triangle = -1;
  };
  // The crossings of the segment from p to q, in the order of `at`. Replaces `found`.
  void cross(const Vec3& p, const Vec3& q, std::vector<Crossing>& found) const;
  // Whether p and q lie on different sides: the number of crossings is odd.
  bool separates(const Vec3& p, const Vec3& q) const;

  // Whether a triangle's box overlaps the box.
  bool near(const Box& box) const;
  const Vec3& normal(Index triangle) const { return normal_[uz(triangle)]; }
  bool empty() const { return triangles_.empty(); }

 private:
  using GridPoint = std::array<std::int64_t, 3>;
  GridPoint rounded(const Vec3& x) const;

  Vec3 origin_ = Vec3::Zero();
  double cells_ = 1.0;  // per metre
  std::vector<GridPoint> vertices_;
  std::vector<Triangle> triangles_;  // those with an area
  std::vector<Vec3> normal_;         // (triangles)
  BoxTree tree_;
  mutable std::vector<Index> near_;
};

}  // namespace sinew
