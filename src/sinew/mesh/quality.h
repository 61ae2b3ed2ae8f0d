// Shape measures of the tets of a mesh.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "sinew/mesh/edges.h"
#include "sinew/mesh/tet_mesh.h"

namespace sinew {

struct Statistics {
  double min = 0;
  double mean = 0;
  double max = 0;
};

constexpr std::size_t kDihedralBins = 18;  // of 10 degrees

struct Quality {
  Vec3 box_min = Vec3::Zero();  // bounding box of the nodes, in the nodes' unit
  Vec3 box_max = Vec3::Zero();
  double volume = 0;          // sum of the tets' signed volumes, in the unit cubed
  Statistics edge_length;     // over the edges, in the nodes' unit
  Statistics tet_volume;      // signed, over the tets, in the unit cubed
  Statistics dihedral_angle;  // over the six of each tet [degrees]; regular tet: 70.53
  Statistics radius_ratio;    // 3 inscribed / circumscribed radius: 1 regular, 0 flat (tets)
  std::array<std::int64_t, kDihedralBins> dihedral_histogram{};  // angles in [10 b, 10 (b + 1))
};

// All zero for an empty mesh; finite for every mesh with finite coordinates up to 1e50, flat tets
// included.
Quality measure_quality(const TetMesh& mesh, const EdgeTable& edges);

// The six interior angles between the faces of a tet [radians], whatever its orientation; between
// corners 01, 02, 03, 12, 13, 23.
std::array<double, 6> dihedral_angles(const std::array<Vec3, 4>& corners);

// 3 r / R of the inscribed and the circumscribed sphere, at least 0 and at most 1.
double radius_ratio(const std::array<Vec3, 4>& corners);

// Volume of each region, in the unit cubed, sorted by label. A mesh without labels has region 0.
struct Region {
  int label = 0;
  Index tets = 0;
  double volume = 0;
};
std::vector<Region> measure_regions(const TetMesh& mesh);

}  // namespace sinew
