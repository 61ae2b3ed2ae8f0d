#include "sinew/forces/gradient_cells.h"

#include <gtest/gtest.h>

#include "sinew/forces/network.h"
#include "tests/support/fields.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

// Two tets that share a face: the gradient of an affine map is that map, and the stresses of a cell
// pull its nodes with no net force.
TEST(GradientCells, GiveTheGradientOfAnAffineMap) {
  const TetMesh mesh = box(Vec3(0.2, 0.1, 0.3), {1, 1, 1});
  GradientCells cells;
  const std::array<Vec3, 4> g = shape_gradients(mesh.nodes, mesh.tets[0]);
  const std::array<Vec3, 4> h = shape_gradients(mesh.nodes, mesh.tets[1]);
  append_cell(cells, mesh.tets[0], g, 1.0, 0.5, 0);
  append_cell(cells, mesh.tets[1], h, 1.0, 0.25, 0);
  finish(cells, mesh.nodes.size());
  Mat3 F;
  F << 1.1, 0.2, -0.1, 0.05, 0.9, 0.1, 0.0, -0.15, 1.05;
  const std::vector<Vec3> x = test::mapped(mesh.nodes, F);
  EXPECT_EQ(cells.count(), 2);
  for (Index c = 0; c < 2; ++c) EXPECT_LE((cell_gradient(cells, x, c) - F).norm(), 1e-14);

  const std::vector<Mat3> stress = {F, Mat3(2.0 * F)};
  Vec3 sum = Vec3::Zero();
  for (Index i = 0; i < mesh.node_count(); ++i) {
    Vec3 expected = Vec3::Zero();
    for (std::size_t a = 0; a < 4; ++a) {
      if (mesh.tets[0][a] == i) expected += F * g[a];
      if (mesh.tets[1][a] == i) expected += 2.0 * F * h[a];
    }
    EXPECT_LE((stress_on_node(cells, stress, i) - expected).norm(), 1e-12);
    sum += expected;
  }
  EXPECT_LE(sum.norm(), 1e-12);
}

}  // namespace
}  // namespace sinew
