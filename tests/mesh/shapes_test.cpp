#include "sinew/mesh/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "sinew/base/error.h"
#include "sinew/mesh/doctor.h"
#include "sinew/mesh/edges.h"
#include "sinew/mesh/quality.h"
#include "sinew/mesh/surface.h"
#include "tests/mesh/made_meshes.h"
#include "tests/support/effort.h"
#include "tests/support/errors.h"

namespace sinew {
namespace {

using test::message_of;

void expect_sound(const TetMesh& mesh) {
  for (const Problem& problem : diagnose(mesh).problems) ADD_FAILURE() << problem.text;
}

TEST(Beam, BenchmarkWorkloads) {
  const std::pair<Index, Index> counts[] = {{4, 1'280}, {8, 10'240}, {17, 98'260}, {37, 1'013'060}};
  for (const auto& [k, tets] : counts) {
    if (test::sanitized && k > 17) continue;
    const TetMesh mesh = beam({0.1, 0.1, 0.4}, {k, k, 4 * k});
    EXPECT_EQ(mesh.tet_count(), tets);
    EXPECT_EQ(mesh.node_count(), (k + 1) * (k + 1) * (4 * k + 1));
    double volume = 0, smallest = 1;
    for (const Tet& tet : mesh.tets) {
      const double v = signed_volume(mesh.nodes, tet);
      volume += v;
      smallest = std::min(smallest, v);
    }
    EXPECT_NEAR(volume, 0.004, 1e-15 * tets);
    const double h = 0.1 / k;
    EXPECT_NEAR(smallest, h * h * h / 6, 1e-6 * h * h * h);
  }
}

TEST(Beam, NodesAreWhereTheWorkloadSays) {
  const Index k = 5;
  const TetMesh mesh = beam({0.1, 0.1, 0.4}, {k, k, 4 * k});
  const double h = 0.1 / k;
  for (Index l = 0; l <= 4 * k; ++l) {
    for (Index j = 0; j <= k; ++j) {
      for (Index i = 0; i <= k; ++i) {
        const Vec3& x = mesh.nodes[uz((l * (k + 1) + j) * (k + 1) + i)];
        EXPECT_EQ(x, Vec3(i * h - 0.05, j * h - 0.05, l * h)) << i << ' ' << j << ' ' << l;
      }
    }
  }
}

TEST(Beam, TetsOfTheFirstTwoCubes) {
  const TetMesh mesh = beam({2, 1, 1}, {2, 1, 1});
  // Nodes of the cubes: 0 1 3 4 6 7 9 10 and, mirrored in x, 2 1 5 4 8 7 11 10.
  const std::vector<Tet> expected = {
      {0, 1, 4, 7}, {0, 4, 3, 9},  {0, 7, 9, 6},  {4, 9, 7, 10},  {0, 4, 9, 7},
      {2, 1, 7, 4}, {2, 4, 11, 5}, {2, 7, 8, 11}, {4, 11, 10, 7}, {2, 4, 7, 11},
  };
  EXPECT_EQ(mesh.tets, expected);
}

TEST(Beam, ConformsForAnyCells) {
  expect_sound(beam({0.3, 0.2, 0.5}, {3, 2, 5}));
  expect_sound(beam({0.1, 0.1, 0.1}, {1, 1, 1}));
  EXPECT_NEAR(testing::quality_of(beam({1, 1, 4}, {2, 2, 8})).dihedral_angle.min, 54.7356, 1e-3);
}

TEST(Box, FillsItsSize) {
  const TetMesh mesh = box({0.3, 0.2, 0.5}, {3, 2, 5});
  expect_sound(mesh);
  EXPECT_EQ(mesh.tet_count(), 6 * 30);
  const Quality quality = testing::quality_of(mesh);
  EXPECT_NEAR(quality.volume, 0.03, 1e-15);
  EXPECT_NEAR(quality.dihedral_angle.min, 45, 1e-9);
  EXPECT_TRUE(quality.box_min.isApprox(Vec3(-0.15, -0.1, -0.25)));
  EXPECT_TRUE(quality.box_max.isApprox(Vec3(0.15, 0.1, 0.25)));
}

TEST(Sphere, CountsAndQuality) {
  for (const Index n : {1, 2, 3, 5, 12}) {
    if (test::sanitized && n > 3) continue;
    const TetMesh mesh = sphere(0.05, n);
    expect_sound(mesh);
    EXPECT_EQ(mesh.tet_count(), 20 * n * n * n);
    EXPECT_EQ(mesh.nodes[0], Vec3::Zero());
    const Quality quality = testing::quality_of(mesh);
    EXPECT_GE(quality.dihedral_angle.min, 36) << n;
    EXPECT_LE(quality.dihedral_angle.max, 130) << n;
    EXPECT_GE(quality.edge_length.min, 0.9 * 0.05 / n) << n;
    EXPECT_LE(quality.edge_length.max, 2 * 0.05 / n) << n;
  }
}

TEST(Sphere, VolumeConvergesWithTheSquareOfTheResolution) {
  const double exact = 4.0 / 3.0 * std::numbers::pi;
  const double error_8 = 1 - testing::quality_of(sphere(1, 8)).volume / exact;
  const double error_16 = 1 - testing::quality_of(sphere(1, 16)).volume / exact;
  EXPECT_LT(error_8, 0.009);
  EXPECT_NEAR(std::log2(error_8 / error_16), 2, 0.05);
}

TEST(Ellipsoid, IsTheScaledSphere) {
  const TetMesh mesh = ellipsoid({0.03, 0.02, 0.01}, 6);
  expect_sound(mesh);
  EXPECT_NEAR(testing::quality_of(mesh).volume / testing::quality_of(sphere(1, 6)).volume, 6e-6,
              1e-18);
  for (const Vec3& x : mesh.nodes) {
    EXPECT_LE(x.cwiseQuotient(Vec3(0.03, 0.02, 0.01)).norm(), 1 + 1e-12);
  }
}

TEST(Cylinder, CountsAndQuality) {
  for (const Index n : {1, 2, 3, 5, 12}) {
    if (test::sanitized && n > 3) continue;
    const TetMesh mesh = cylinder(0.05, 0.15, n);
    expect_sound(mesh);
    EXPECT_EQ(mesh.tet_count(), 18 * n * n * 3 * n);
    const Quality quality = testing::quality_of(mesh);
    EXPECT_GE(quality.dihedral_angle.min, 34) << n;
    EXPECT_LE(quality.dihedral_angle.max, 126) << n;
    EXPECT_NEAR(quality.box_max.z(), 0.075, 1e-15);
    EXPECT_NEAR(quality.box_min.z(), -0.075, 1e-15);
  }
}

TEST(Cylinder, VolumeConvergesWithTheSquareOfTheResolution) {
  const double exact = 2 * std::numbers::pi;
  const double error_4 = 1 - testing::quality_of(cylinder(1, 2, 4)).volume / exact;
  const double error_8 = 1 - testing::quality_of(cylinder(1, 2, 8)).volume / exact;
  EXPECT_LT(error_8, 0.003);
  EXPECT_NEAR(std::log2(error_4 / error_8), 2, 0.02);
}

TEST(Cylinder, ShorterThanARingIsOneLayer) {
  const TetMesh mesh = cylinder(1, 0.01, 3);
  expect_sound(mesh);
  EXPECT_EQ(mesh.tet_count(), 18 * 9);
}

TEST(HollowSphere, CountsAndQuality) {
  const std::pair<double, Index> cases[] = {{0.5, 4}, {0.5, 5}, {0.7, 2}, {0.9, 1}, {0.9, 3}};
  for (const auto& [inner, n] : cases) {
    if (test::sanitized && n > 2) continue;
    const TetMesh mesh = hollow_sphere(1, inner, n);
    expect_sound(mesh);
    const auto m = static_cast<Index>(std::round(-0.95 * n / std::log(inner)));
    EXPECT_EQ(mesh.tet_count(), 60 * m * m * n);
    EXPECT_EQ(mesh.node_count(), (10 * m * m + 2) * (n + 1));
    const Quality quality = testing::quality_of(mesh);
    EXPECT_GE(quality.dihedral_angle.min, 33) << inner << ' ' << n;
    EXPECT_LE(quality.dihedral_angle.max, 122) << inner << ' ' << n;
    double least = 2, most = 0;
    for (const Vec3& x : mesh.nodes) {
      least = std::min(least, x.norm());
      most = std::max(most, x.norm());
    }
    EXPECT_NEAR(least, inner, 1e-15);
    EXPECT_NEAR(most, 1, 1e-15);
  }
}

TEST(HollowSphere, IsClosedInsideAndOutside) {
  const TetMesh mesh = hollow_sphere(1, 0.5, 3);
  const Surface surface = build_surface(mesh.tets, mesh.node_count());
  EXPECT_EQ(connected_components(surface.triangles, mesh.node_count()).count, 2);
  EXPECT_EQ(surface.triangles.size(), 2U * 20 * 4 * 4);
  ASSERT_EQ(mesh.faces.size(), surface.triangles.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    for (const Index corner : mesh.faces[f])
      EXPECT_NEAR(mesh.nodes[uz(corner)].norm(), mesh.face_label[f] == 1 ? 1.0 : 0.5, 1e-15);
}

TEST(HollowSphere, VolumeConvergesWithTheSquareOfTheResolution) {
  const double exact = 4.0 / 3.0 * std::numbers::pi * (1 - 0.125);
  const double error_4 = 1 - testing::quality_of(hollow_sphere(1, 0.5, 4)).volume / exact;
  const double error_8 = 1 - testing::quality_of(hollow_sphere(1, 0.5, 8)).volume / exact;
  EXPECT_LT(error_4, 0.04);
  EXPECT_NEAR(std::log2(error_4 / error_8), 2, 0.4);
}

TEST(HollowSphere, AnyWallIsSound) {
  expect_sound(hollow_sphere(1, 0.01, 1));
  if (!test::sanitized) expect_sound(hollow_sphere(1, 0.01, 7));
  expect_sound(hollow_sphere(1, 0.99, 1));
}

TEST(Shapes, WrongArguments) {
  EXPECT_EQ(message_of([] {
              beam({0.1, 0, 0.4}, {1, 1, 1});
            }),
            "beam: size[1] is 0, expected a length from 1e-6 to 1e6 m");
  EXPECT_EQ(message_of([] {
              box({0.1, 0.1, std::nan("")}, {1, 1, 1});
            }),
            "box: size[2] is nan, expected a length from 1e-6 to 1e6 m");
  EXPECT_EQ(message_of([] {
              beam({1, 1, 1}, {1, 1, -4});
            }),
            "beam: cells[2] is -4, expected 1 or more");
  EXPECT_EQ(message_of([] {
              box({1, 1, 1}, {1, 1, 4}, 0.5);
            }),
            "box: jitter is 0.5, expected a share from 0 to 0.45");
  EXPECT_EQ(message_of([] { sphere(-1, 3); }),
            "sphere: radius is -1, expected a length from 1e-6 to 1e6 m");
  EXPECT_EQ(message_of([] {
              ellipsoid({1, 1, 1e300}, 3);
            }),
            "ellipsoid: radii[2] is 1e+300, expected a length from 1e-6 to 1e6 m");
  EXPECT_EQ(message_of([] { cylinder(1, 1, 0); }), "cylinder: resolution is 0, expected 1 or more");
  EXPECT_EQ(message_of([] { hollow_sphere(1, 1, 4); }),
            "hollow_sphere: inner_radius is 1, expected less than the radius 1");
  EXPECT_EQ(message_of([] { hollow_sphere(1, 0.5, 0); }),
            "hollow_sphere: resolution is 0, expected 1 or more");
}

TEST(Shapes, AbsurdSizesAreRefusedAtOnce) {
  constexpr Index kLargest = std::numeric_limits<Index>::max();
  EXPECT_EQ(message_of([] {
              box({1, 1, 1}, {1000, 1000, 1000});
            }),
            "box: cells asks for 6e+03 million tets, expected 20 million or fewer");
  EXPECT_EQ(message_of([] {
              beam({1, 1, 1}, {kLargest, kLargest, kLargest});
            }),
            "beam: cells asks for 4.95e+22 million tets, expected 20 million or fewer");
  EXPECT_EQ(message_of([] { sphere(1, 101); }),
            "sphere: resolution asks for 20.6 million tets, expected 20 million or fewer");
  EXPECT_EQ(message_of([] { cylinder(1e-6, 1e6, kLargest); }),
            "cylinder: resolution asks for 1.78e+35 million tets, expected 20 million or fewer");
  EXPECT_EQ(
      message_of([] { hollow_sphere(1, 0.999999, 1); }),
      "hollow_sphere: resolution asks for 5.42e+07 million tets, expected 20 million or fewer");
}

}  // namespace
}  // namespace sinew
