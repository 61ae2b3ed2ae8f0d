// A tetrahedral mesh from a file or a shape: geometry and labels, without material.
#pragma once

#include <cstdint>
#include <vector>

#include "sinew/base/vec.h"

namespace sinew {

struct TetMesh {
  std::vector<Vec3> nodes;      // position, in the file's unit until scaled to [m] (nodes)
  std::vector<Tet> tets;        // node ids (tets)
  std::vector<int> tet_label;   // region label (tets); empty: all 0
  std::vector<int> node_label;  // label (nodes); empty: none
  std::vector<Triangle> faces;  // labelled faces of the file (faces); may be empty
  std::vector<int> face_label;  // label (faces)

  Index node_count() const { return static_cast<Index>(nodes.size()); }
  Index tet_count() const { return static_cast<Index>(tets.size()); }
};

// Signed volume of one tet: (x1-x0) . ((x2-x0) x (x3-x0)) / 6, positive when the corners 1, 2, 3
// run counter-clockwise seen from corner 0's far side. In the cube of the coordinates' unit.
inline double signed_volume(const Vec3& x0, const Vec3& x1, const Vec3& x2, const Vec3& x3) {
  return (x1 - x0).dot((x2 - x0).cross(x3 - x0)) / 6.0;
}

inline double signed_volume(const std::vector<Vec3>& x, const Tet& t) {
  return signed_volume(x[static_cast<std::size_t>(t[0])], x[static_cast<std::size_t>(t[1])],
                       x[static_cast<std::size_t>(t[2])], x[static_cast<std::size_t>(t[3])]);
}

}  // namespace sinew
