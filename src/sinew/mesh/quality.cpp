#include "sinew/mesh/quality.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "sinew/mesh/faces.h"

namespace sinew {
namespace {

// Collects min, mean and max one value at a time.
class Accumulator {
 public:
  void add(double value) {
    min_ = std::min(min_, value);
    max_ = std::max(max_, value);
    sum_ += value;
    ++count_;
  }
  Statistics statistics() const {
    if (count_ == 0) return {};
    return {min_, sum_ / static_cast<double>(count_), max_};
  }

 private:
  double min_ = std::numeric_limits<double>::infinity();
  double max_ = -std::numeric_limits<double>::infinity();
  double sum_ = 0;
  std::int64_t count_ = 0;
};

std::array<Vec3, 4> corners_of(const TetMesh& mesh, const Tet& tet) {
  return {mesh.nodes[uz(tet[0])], mesh.nodes[uz(tet[1])], mesh.nodes[uz(tet[2])],
          mesh.nodes[uz(tet[3])]};
}

// Twice the area vector of each face, outward for a positive tet.
std::array<Vec3, 4> face_normals(const std::array<Vec3, 4>& x) {
  std::array<Vec3, 4> normals;
  for (std::size_t c = 0; c < 4; ++c) {
    const auto& f = kTetFaces[c];
    normals[c] = (x[f[1]] - x[f[0]]).cross(x[f[2]] - x[f[0]]);
  }
  return normals;
}

}  // namespace

std::array<double, 6> dihedral_angles(const std::array<Vec3, 4>& corners) {
  // The edge of two corners lies between the faces opposite the other two.
  constexpr std::size_t kFaces[6][2] = {{2, 3}, {1, 3}, {1, 2}, {0, 3}, {0, 2}, {0, 1}};
  const std::array<Vec3, 4> normals = face_normals(corners);
  std::array<double, 6> angles;
  for (std::size_t e = 0; e < 6; ++e) {
    const Vec3 a = normals[kFaces[e][0]].stableNormalized();
    const Vec3 b = normals[kFaces[e][1]].stableNormalized();
    angles[e] = std::numbers::pi - std::atan2(a.cross(b).norm(), a.dot(b));
  }
  return angles;
}

double radius_ratio(const std::array<Vec3, 4>& corners) {
  // With a, b, c the edges at corner 0: r = 3 V / area, R = |a^2 bxc + b^2 cxa + c^2 axb| / (12 V).
  const Vec3 a = corners[1] - corners[0], b = corners[2] - corners[0], c = corners[3] - corners[0];
  const double six_volume = a.dot(b.cross(c));
  double area = 0;
  for (const Vec3& n : face_normals(corners)) area += n.norm() / 2;
  const Vec3 numerator =
      a.squaredNorm() * b.cross(c) + b.squaredNorm() * c.cross(a) + c.squaredNorm() * a.cross(b);
  const double product = area * numerator.norm();  // = 36 V^2 r^-1 R
  return product > 0 ? std::min(1.0, 3 * six_volume * six_volume / product) : 0;
}

Quality measure_quality(const TetMesh& mesh, const EdgeTable& edges) {
  Quality quality;
  if (!mesh.nodes.empty()) quality.box_min = quality.box_max = mesh.nodes.front();
  for (const Vec3& x : mesh.nodes) {
    quality.box_min = quality.box_min.cwiseMin(x);
    quality.box_max = quality.box_max.cwiseMax(x);
  }

  Accumulator lengths, volumes, angles, ratios;
  for (const auto& [i, j] : edges.edges) {
    lengths.add((mesh.nodes[uz(j)] - mesh.nodes[uz(i)]).norm());
  }
  for (const Tet& tet : mesh.tets) {
    const std::array<Vec3, 4> corners = corners_of(mesh, tet);
    const double volume = signed_volume(mesh.nodes, tet);
    quality.volume += volume;
    volumes.add(volume);
    ratios.add(radius_ratio(corners));
    for (const double angle : dihedral_angles(corners)) {
      const double degrees = angle * 180 / std::numbers::pi;
      angles.add(degrees);
      const auto bin = static_cast<std::size_t>(degrees / 10);
      ++quality.dihedral_histogram[std::min(bin, kDihedralBins - 1)];
    }
  }
  quality.edge_length = lengths.statistics();
  quality.tet_volume = volumes.statistics();
  quality.dihedral_angle = angles.statistics();
  quality.radius_ratio = ratios.statistics();
  return quality;
}

std::vector<Region> measure_regions(const TetMesh& mesh) {
  std::map<int, Region> by_label;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const int label = mesh.tet_label.empty() ? 0 : mesh.tet_label[t];
    Region& region = by_label[label];
    region.label = label;
    ++region.tets;
    region.volume += signed_volume(mesh.nodes, mesh.tets[t]);
  }
  std::vector<Region> regions;
  for (const auto& [label, region] : by_label) regions.push_back(region);
  return regions;
}

}  // namespace sinew
