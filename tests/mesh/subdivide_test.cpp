#include "sinew/mesh/subdivide.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "sinew/mesh/doctor.h"
#include "sinew/mesh/edges.h"
#include "sinew/mesh/quality.h"
#include "sinew/mesh/surface.h"
#include "tests/mesh/made_meshes.h"

namespace sinew {
namespace {

TEST(Subdivide, OneTet) {
  TetMesh coarse = testing::regular_tet();
  coarse.tet_label = {4};
  coarse.node_label = {1, 1, 2, 2};
  coarse.faces = {{0, 2, 1}, {1, 2, 0}};
  coarse.face_label = {8, 9};
  const TetMesh fine = subdivide(coarse);
  EXPECT_EQ(fine.node_count(), 10);
  EXPECT_EQ(fine.tet_label, std::vector<int>(8, 4));
  EXPECT_EQ(fine.node_label, (std::vector<int>{1, 1, 2, 2, 1, 0, 0, 0, 0, 2}));
  EXPECT_EQ(fine.nodes[4], Vec3(0.5, 0, 0));
  EXPECT_EQ(fine.faces.size(), 8U);
  EXPECT_EQ(fine.face_label, (std::vector<int>{8, 8, 8, 8, 9, 9, 9, 9}));
  EXPECT_EQ(fine.faces[0], (Triangle{0, 5, 4}));
  for (const Tet& tet : fine.tets) {
    EXPECT_NEAR(signed_volume(fine.nodes, tet), std::sqrt(2.0) / 12 / 8, 1e-15);
  }
  EXPECT_TRUE(diagnose(fine).problems.empty());
}

TEST(Subdivide, FaceOfNoTetIsLeftOut) {
  TetMesh mesh = testing::joined(testing::corner_tet(), testing::corner_tet(), {2, 0, 0});
  mesh.faces = {{0, 1, 4}};
  EXPECT_TRUE(subdivide(mesh).faces.empty());
}

RC_GTEST_PROP(Subdivide, KeepsShapeAndConforms, ()) {
  const TetMesh coarse = testing::random_mesh();
  const TetMesh fine = subdivide(coarse);
  RC_ASSERT(fine.tets.size() == 8 * coarse.tets.size());
  const auto volume = [](const TetMesh& mesh) {
    double sum = 0;
    for (const Tet& tet : mesh.tets) sum += signed_volume(mesh.nodes, tet);
    return sum;
  };
  for (const Tet& tet : fine.tets) RC_ASSERT(signed_volume(fine.nodes, tet) > 0);
  RC_ASSERT(std::abs(volume(fine) - volume(coarse)) < 1e-12);
  const Surface surface = build_surface(coarse.tets, coarse.node_count());
  const Surface fine_surface = build_surface(fine.tets, fine.node_count());
  RC_ASSERT(fine_surface.triangles.size() == 4 * surface.triangles.size());
  RC_ASSERT(diagnose(fine).find(ProblemKind::overlap) == nullptr);
}

}  // namespace
}  // namespace sinew
