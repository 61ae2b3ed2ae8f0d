#include "sinew/mesh/quality.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "tests/mesh/made_meshes.h"

namespace sinew {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

std::array<Vec3, 4> corners(const TetMesh& mesh) {
  return {mesh.nodes[0], mesh.nodes[1], mesh.nodes[2], mesh.nodes[3]};
}

TEST(Quality, RegularTet) {
  const std::array<Vec3, 4> x = corners(testing::regular_tet());
  for (const double angle : dihedral_angles(x)) EXPECT_NEAR(angle, std::acos(1.0 / 3.0), 1e-12);
  EXPECT_NEAR(radius_ratio(x), 1, 1e-12);
}

TEST(Quality, CornerTet) {
  const std::array<Vec3, 4> x = corners(testing::corner_tet());
  const std::array<double, 6> angles = dihedral_angles(x);
  for (std::size_t e = 0; e < 3; ++e) EXPECT_NEAR(angles[e], 90 * kDegree, 1e-12);
  for (std::size_t e = 3; e < 6; ++e) EXPECT_NEAR(angles[e], std::atan(std::sqrt(2.0)), 1e-12);
  // r = 1 / (3 + sqrt 3), R = sqrt(3) / 2.
  EXPECT_NEAR(radius_ratio(x), 6 / (std::sqrt(3.0) * (3 + std::sqrt(3.0))), 1e-12);
}

TEST(Quality, OrientationAndSizeDoNotMatter) {
  std::array<Vec3, 4> x = corners(testing::corner_tet());
  const double ratio = radius_ratio(x);
  const double angle = dihedral_angles(x)[0];
  std::swap(x[2], x[3]);
  for (Vec3& p : x) p = 1e-7 * p + Vec3(1, 2, 3) * 1e-7;
  EXPECT_NEAR(radius_ratio(x), ratio, 1e-9);
  EXPECT_NEAR(dihedral_angles(x)[0], angle, 1e-9);
}

TEST(Quality, FlatTetsAreFinite) {
  const std::array<Vec3, 4> square = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)};
  EXPECT_EQ(radius_ratio(square), 0);
  for (const double angle : dihedral_angles(square)) {
    EXPECT_TRUE(std::abs(angle) < 1e-12 || std::abs(angle - std::numbers::pi) < 1e-12);
  }
  const std::array<Vec3, 4> point = {Vec3::Ones(), Vec3::Ones(), Vec3::Ones(), Vec3::Ones()};
  EXPECT_EQ(radius_ratio(point), 0);
  for (const double angle : dihedral_angles(point)) EXPECT_TRUE(std::isfinite(angle));
}

TEST(Quality, OfAMesh) {
  const Quality quality = testing::quality_of(beam({1, 1, 2}, {1, 1, 2}));
  EXPECT_NEAR(quality.volume, 2, 1e-14);
  EXPECT_NEAR(quality.tet_volume.min, 1.0 / 6, 1e-14);
  EXPECT_NEAR(quality.tet_volume.max, 1.0 / 3, 1e-14);
  EXPECT_NEAR(quality.tet_volume.mean, 0.2, 1e-14);
  EXPECT_NEAR(quality.edge_length.min, 1, 1e-14);
  EXPECT_NEAR(quality.edge_length.max, std::sqrt(2.0), 1e-14);
  // 20 edges of the cubes and 11 diagonals of their squares.
  EXPECT_NEAR(quality.edge_length.mean, (20 + 11 * std::sqrt(2.0)) / 31, 1e-14);
  EXPECT_EQ(quality.box_min, Vec3(-0.5, -0.5, 0));
  EXPECT_EQ(quality.box_max, Vec3(0.5, 0.5, 2));
  // Per cube: 12 right angles and 12 of 54.7 degrees at the corners, 6 of 70.5 inside.
  EXPECT_EQ(quality.dihedral_histogram[5], 24);
  EXPECT_EQ(quality.dihedral_histogram[7], 12);
  EXPECT_EQ(quality.dihedral_histogram[8] + quality.dihedral_histogram[9], 24);
  EXPECT_NEAR(quality.radius_ratio.max, 1, 1e-12);
}

TEST(Quality, OfAnEmptyMesh) {
  const Quality quality = testing::quality_of({});
  EXPECT_EQ(quality.volume, 0);
  EXPECT_EQ(quality.dihedral_angle.max, 0);
  EXPECT_EQ(quality.edge_length.min, 0);
}

RC_GTEST_PROP(Quality, BoundsHoldOnAnyMesh, ()) {
  const TetMesh mesh = testing::random_mesh();
  const Quality quality = testing::quality_of(mesh);
  const auto& histogram = quality.dihedral_histogram;
  RC_ASSERT(std::accumulate(histogram.begin(), histogram.end(), std::int64_t{0}) ==
            6 * static_cast<std::int64_t>(mesh.tets.size()));
  RC_ASSERT(quality.radius_ratio.min >= 0 && quality.radius_ratio.max <= 1);
  RC_ASSERT(quality.dihedral_angle.min <= quality.dihedral_angle.mean);
  RC_ASSERT(quality.dihedral_angle.mean <= quality.dihedral_angle.max);
}

TEST(Regions, AreSortedByLabel) {
  TetMesh mesh = box({2, 1, 1}, {2, 1, 1});
  mesh.tet_label = {7, 7, 7, 7, 7, 7, -1, -1, -1, -1, -1, 7};
  const std::vector<Region> regions = measure_regions(mesh);
  ASSERT_EQ(regions.size(), 2U);
  EXPECT_EQ(regions[0].label, -1);
  EXPECT_EQ(regions[0].tets, 5);
  EXPECT_NEAR(regions[0].volume, 5.0 / 6, 1e-15);
  EXPECT_EQ(regions[1].label, 7);
  EXPECT_EQ(regions[1].tets, 7);
  mesh.tet_label.clear();
  ASSERT_EQ(measure_regions(mesh).size(), 1U);
  EXPECT_EQ(measure_regions(mesh)[0].label, 0);
}

}  // namespace
}  // namespace sinew
