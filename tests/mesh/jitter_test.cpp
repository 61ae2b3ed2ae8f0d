#include "sinew/mesh/jitter.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sinew/mesh/doctor.h"
#include "sinew/mesh/shapes.h"

namespace sinew {
namespace {

double volume(const TetMesh& mesh) {
  double sum = 0;
  for (const Tet& t : mesh.tets) sum += signed_volume(mesh.nodes, t);
  return sum;
}

TEST(Jitter, NoneChangesNoBit) {
  EXPECT_EQ(beam({0.1, 0.1, 0.4}, {3, 3, 12}, 0.0).nodes, beam({0.1, 0.1, 0.4}, {3, 3, 12}).nodes);
}

TEST(Jitter, NodesMoveWithinTheirFacesAndNotTooFar) {
  const Vec3 size(0.3, 0.2, 0.5);
  const std::array<Index, 3> cells = {6, 4, 5};
  const Vec3 h(0.05, 0.05, 0.1);
  const double share = 0.2;
  const TetMesh regular = box(size, cells);
  const TetMesh mesh = box(size, cells, share);
  EXPECT_EQ(mesh.tets, regular.tets);
  Vec3 most = Vec3::Zero();
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const Vec3 move = (mesh.nodes[i] - regular.nodes[i]).cwiseQuotient(h);
    EXPECT_LE(move.cwiseAbs().maxCoeff(), share);
    for (int axis = 0; axis < 3; ++axis) {
      const bool on_face = std::abs(std::abs(regular.nodes[i][axis]) - size[axis] / 2) < 1e-12;
      if (on_face) {
        EXPECT_EQ(move[axis], 0.0);
      } else {
        EXPECT_NE(move[axis], 0.0);
        most[axis] = std::max(most[axis], std::abs(move[axis]));
      }
    }
  }
  EXPECT_GT(most.minCoeff(), 0.95 * share);
  EXPECT_NEAR(volume(mesh), 0.03, 1e-15);
}

TEST(Jitter, TetsKeepATenthOfTheirVolumeAtAnyShare) {
  for (const double share : {0.1, 0.3, 0.45}) {
    for (const auto& shape : {beam, box}) {
      const Vec3 size(0.1, 0.3, 0.2);
      const TetMesh regular = shape(size, {12, 8, 10}, 0.0);
      const TetMesh mesh = shape(size, {12, 8, 10}, share);
      EXPECT_TRUE(diagnose(mesh).problems.empty());
      double least = 1, most = 1;
      for (const Tet& t : mesh.tets) {
        const double kept = signed_volume(mesh.nodes, t) / signed_volume(regular.nodes, t);
        least = std::min(least, kept);
        most = std::max(most, kept);
      }
      EXPECT_GE(least, kJitterKeepsVolume);
      EXPECT_LT(least, 1 - share);
      EXPECT_GT(most, 1 + 2 * share);
    }
  }
}

}  // namespace
}  // namespace sinew
