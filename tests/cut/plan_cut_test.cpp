#include "sinew/cut/plan_cut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "sinew/io/mesh_io.h"
#include "sinew/mesh/faces.h"
#include "sinew/mesh/pinches.h"
#include "sinew/mesh/quality.h"
#include "sinew/mesh/shapes.h"
#include "tests/cut/cuts.h"
#include "tests/support/source_dir.h"

namespace sinew {
namespace {

#ifdef SINEW_SANITIZED
constexpr std::uint64_t share = 40;
#else
constexpr std::uint64_t share = 1;
#endif

double least_height(const test::CutPiece& piece) {
  double least = 1e300;
  for (const Tet& t : piece.tets) {
    for (const auto& f : kTetFaces) {
      const Vec3& a = piece.nodes[uz(t[f[0]])];
      const double area = (piece.nodes[uz(t[f[1]])] - a).cross(piece.nodes[uz(t[f[2]])] - a).norm();
      least = std::min(least, 6.0 * signed_volume(piece.nodes, t) / area);
    }
  }
  return least;
}

// Every face belongs to one or two tets.
bool conforms(const test::CutPiece& piece) {
  const FaceTable faces = build_faces(piece.tets, static_cast<Index>(piece.nodes.size()));
  for (Index f = 0; f < faces.face_count(); ++f)
    if (faces.sides_of(f).size() > 2) return false;
  return true;
}

struct Shape {
  const char* name;
  TetMesh mesh;
};

std::vector<Shape> shapes_to_cut() {
  return {{"beam", beam(Vec3(0.1, 0.1, 0.4), {4, 4, 16})},
          {"jittered box", box(Vec3(0.1, 0.1, 0.1), {6, 6, 6}, 0.3)},
          {"ball", sphere(0.05, 5)}};
}

// Up to three cuts that cross, of many meshes.
TEST(PlanCut, AnyCutLeavesASoundMeshOfTheSameVolume) {
  for (const Shape& shape : shapes_to_cut()) {
    SCOPED_TRACE(shape.name);
    int opened = 0;
    for (std::uint64_t n = 0; n < 670 / share; ++n) {
      test::CutPiece piece(shape.mesh);
      const double volume = piece.volume(), height = least_height(piece);
      for (std::uint64_t c = 0; c < 1 + n % 3; ++c)
        opened += piece.cut(test::random_disc(7 * n + c, piece.bounds())) ? 1 : 0;
      ASSERT_NEAR(piece.volume(), volume, 1e-12 * volume) << n;
      for (const Tet& t : piece.tets) ASSERT_GT(signed_volume(piece.nodes, t), 0.0) << n;
      ASSERT_TRUE(conforms(piece)) << n;
      ASSERT_GT(least_height(piece), 0.1 * height) << n;
      const std::vector<Triangle> surface =
          build_surface(piece.tets, static_cast<Index>(piece.nodes.size())).triangles;
      ASSERT_TRUE(non_manifold_edges(surface).empty()) << n;
      ASSERT_TRUE(non_manifold_nodes(surface).empty()) << n;
    }
    EXPECT_GT(opened, 1000 / static_cast<int>(share));
  }
}

// After a plane all through, no part has more than a crumb on its other side: what is smaller than
// a few tets stays attached, and the surface of the cut passes up to half an edge beside the plane.
TEST(PlanCut, APlaneAllThroughSeparatesItsSides) {
  for (const Shape& shape : shapes_to_cut()) {
    SCOPED_TRACE(shape.name);
    const test::CutPiece whole(shape.mesh);
    const double cell = *std::max_element(whole.size.begin(), whole.size.end());
    for (std::uint64_t n = 0; n < 200 / share; ++n) {
      test::CutPiece piece = whole;
      for (std::uint64_t c = 0; c < 1 + n % 3; ++c) {
        const Box box = piece.bounds();
        const Vec3 center =
            0.5 * (box.lo + box.hi) +
            0.4 * (box.hi - box.lo).cwiseProduct(random_point(17 * n + c) - Vec3::Constant(0.5));
        Vec3 normal = (random_point(91 * n + c) - Vec3::Constant(0.5)).normalized();
        if (n % 10 == 0) normal = Vec3::Unit(static_cast<Index>(c));  // along layers of nodes
        EXPECT_TRUE(piece.cut(test::disc(center, normal, 3.0))) << n;
        const Components parts = piece.parts();
        struct Side {
          double reach = 0.0, volume = 0.0;
        };
        std::vector<std::array<Side, 2>> sides(uz(parts.count));
        for (std::size_t t = 0; t < piece.tets.size(); ++t) {
          double middle = 0.0;
          for (const Index node : piece.tets[t]) {
            const double d = normal.dot(piece.nodes[uz(node)] - center);
            middle += 0.25 * d;
            Side& side = sides[uz(parts.of[t])][d > 0.0 ? 1 : 0];
            side.reach = std::max(side.reach, std::abs(d));
          }
          sides[uz(parts.of[t])][middle > 0.0 ? 1 : 0].volume +=
              signed_volume(piece.nodes, piece.tets[t]);
        }
        for (const auto& [below, above] : sides)
          ASSERT_TRUE(std::min(below.reach, above.reach) < 0.7 * cell ||
                      std::min(below.volume, above.volume) < 0.35 * std::pow(cell, 3.0))
              << n << " " << c;
      }
    }
  }
}

TEST(PlanCut, APlaneAlongALayerOfNodesSplitsNoEdge) {
  const test::CutPiece piece(beam(Vec3(0.1, 0.1, 0.4), {4, 4, 16}));
  const BodyCut cut = piece.plan(test::disc(Vec3(0.0, 0.0, 0.2), Vec3::UnitZ(), 1.0));
  EXPECT_TRUE(cut.splits.empty());
  EXPECT_EQ(cut.faces.size(), 32u);  // two triangles for each of 16 cells
}

TEST(PlanCut, ADiscInsideOpensASlitAndItsRimStaysClosed) {
  test::CutPiece piece(box(Vec3(0.1, 0.1, 0.1), {8, 8, 8}));
  const std::size_t before = piece.nodes.size();
  const double area =
      surface_area(piece.nodes, build_surface(piece.tets, static_cast<Index>(before)).triangles);
  ASSERT_TRUE(piece.cut(test::disc(Vec3::Zero(), Vec3(1.0, 2.0, 0.5), 0.035)));
  EXPECT_EQ(piece.parts().count, 1);
  const Surface surface = build_surface(piece.tets, static_cast<Index>(piece.nodes.size()));
  // Both lips, up to the cells at the rim that the disc does not pass completely.
  const double lips = surface_area(piece.nodes, surface.triangles) - area;
  const double disc = std::numbers::pi * 0.035 * 0.035;
  EXPECT_LT(lips, 2.0 * 1.1 * disc);
  EXPECT_GT(lips, 2.0 * 0.5 * disc);
}

TEST(PlanCut, WhatDoesNotReachTheBodyCutsNothing) {
  const test::CutPiece piece(beam(Vec3(0.1, 0.1, 0.4), {2, 2, 8}));
  EXPECT_TRUE(piece.plan(test::disc(Vec3(1.0, 0.0, 0.2), Vec3::UnitX(), 0.5)).empty());
  EXPECT_TRUE(piece.plan({}).empty());
  // A needle's prick: smaller than a cell.
  const BodyCut prick = piece.plan(test::disc(Vec3(0.01, 0.01, 0.21), Vec3::UnitX(), 1e-4));
  EXPECT_TRUE(prick.empty());
  EXPECT_TRUE(prick.splits.empty());
}

// The same cut of a moved and deformed body, with the surface deformed alike.
TEST(PlanCut, DoesNotDependOnWhereTheBodyIs) {
  const test::CutPiece piece(box(Vec3(0.1, 0.1, 0.1), {5, 5, 5}, 0.2));
  const Mat3 F = (Mat3() << 1.1, 0.2, 0.0, -0.1, 0.9, 0.1, 0.0, 0.05, 1.05).finished();
  const auto moved = [&](const std::vector<Vec3>& all) {
    std::vector<Vec3> out;
    for (const Vec3& x : all) out.push_back(F * x + Vec3(0.3, -0.2, 0.5));
    return out;
  };
  CutTriangles surface = test::disc(Vec3(0.01, 0.0, 0.0), Vec3(1.0, 0.3, 0.2), 0.06);
  const BodyCut rest = piece.plan(surface);
  surface.vertices = moved(surface.vertices);
  const std::vector<Vec3> x = moved(piece.nodes);
  Box box;
  for (const Vec3& p : x) box.add(p);
  const BodyCut there =
      plan_cut({piece.nodes, x, piece.tets, piece.size}, CutSurface(surface, box));
  // The snapping measures angles where the surface is given: most of the cut is the same.
  std::vector<Triangle> common;
  std::set_intersection(rest.faces.begin(), rest.faces.end(), there.faces.begin(),
                        there.faces.end(), std::back_inserter(common));
  EXPECT_NEAR(static_cast<double>(rest.faces.size()), static_cast<double>(there.faces.size()),
              0.1 * static_cast<double>(rest.faces.size()));
}

// Blades along faces, through nodes and edges, folded, twice, tiny, huge, far away.
TEST(PlanCut, NoPathOfABladeBreaksIt) {
  const test::CutPiece whole(beam(Vec3(0.1, 0.1, 0.2), {2, 2, 4}));
  const double volume = whole.volume();
  std::uint64_t seed = 1;
  for (std::uint64_t n = 0; n < 10000 / share; ++n) {
    test::CutPiece piece = whole;
    CutTriangles blade;
    const std::uint64_t rows = 2 + n % 4;
    const auto node = [&] {
      return piece.nodes[static_cast<std::size_t>(random_number(seed++) *
                                                  static_cast<double>(piece.nodes.size()))];
    };
    for (std::uint64_t r = 0; r < 2 * rows; ++r) {
      switch ((n / 4) % 6) {
        case 0:  // from node to node
          blade.vertices.push_back(node());
          break;
        case 1:  // from edge to edge
          blade.vertices.push_back(0.5 * (node() + node()));
          break;
        case 2:  // anywhere, coarsely rounded
          blade.vertices.push_back(0.05 * (6.0 * random_point(seed++)).array().round().matrix() -
                                   Vec3::Constant(0.1));
          break;
        case 3:  // smaller than a tet
          blade.vertices.push_back(node() + 1e-4 * random_point(seed++));
          break;
        case 4:  // far beyond
          blade.vertices.push_back(1e3 * (random_point(seed++) - Vec3::Constant(0.5)));
          break;
        default:  // twice the same rows
          blade.vertices.push_back(r < 4 ? node() : blade.vertices[r - 4]);
      }
    }
    for (Index r = 0; r + 1 < static_cast<Index>(rows); ++r) {
      blade.triangles.push_back({2 * r, 2 * r + 1, 2 * r + 2});
      blade.triangles.push_back({2 * r + 1, 2 * r + 3, 2 * r + 2});
    }
    piece.cut(blade);
    piece.cut(blade);  // again: most of it is cut already
    ASSERT_NEAR(piece.volume(), volume, 1e-12 * volume) << n;
    for (const Tet& t : piece.tets) ASSERT_GT(signed_volume(piece.nodes, t), 0.0) << n;
    ASSERT_TRUE(conforms(piece)) << n;
  }
}

}  // namespace
}  // namespace sinew
