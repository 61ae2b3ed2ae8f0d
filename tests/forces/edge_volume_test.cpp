#include "sinew/forces/edge_volume.h"

#include <gtest/gtest.h>

#include "tests/support/fields.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

Model jittered_box(double poisson) {
  BodySpec spec;
  spec.name = "box";
  spec.mesh = box(Vec3(0.1, 0.1, 0.1), {2, 2, 2}, 0.3);
  Material material;
  material.poisson = poisson;
  material.beta = 0.0;
  spec.materials = {material};
  spec.regions = {"all"};
  Model m;
  add_body(m, spec);
  finish(m);
  return m;
}

TEST(EdgeVolume, CofactorIsTheDerivativeOfTheDeterminant) {
  Mat3 F, dF;
  F << 1.3, 0.2, -0.1, 0.4, -0.8, 0.3, -0.2, 0.1, 1.1;
  dF << 0.5, -1.0, 2.0, 0.3, 0.7, -0.4, 1.1, 0.2, -0.9;
  const double h = 1e-5;
  const double slope = ((F + h * dF).determinant() - (F - h * dF).determinant()) / (2.0 * h);
  EXPECT_NEAR(cofactor(F).cwiseProduct(dF).sum(), slope, 1e-9);
  const Mat3 change = (cofactor(F + h * dF) - cofactor(F - h * dF)) / (2.0 * h);
  EXPECT_LE((cofactor_change(F, dF) - change).norm(), 1e-9);
}

TEST(EdgeVolume, StressAndItsChangeAreDerivativesOfTheEnergy) {
  for (const double poisson : {-0.3, 0.3}) {
    const Model m = jittered_box(poisson);
    const std::vector<Vec3> x = test::shaken(m.rest_position, 0.02);
    EdgeState at;
    compute_edge_state(m, x, at);
    EXPECT_NEAR(edge_volume_energy(m, m.rest_position), 0.0, 1e-14);
    const double h = 1e-6;
    for (Index i = 0; i < m.node_count(); i += 4) {
      const Vec3 force = -stress_on_node(m.edge_cells, at.stress, i);
      for (int c = 0; c < 3; ++c) {
        std::vector<Vec3> above = x, below = x, u(x.size(), Vec3::Zero());
        above[uz(i)][c] += h;
        below[uz(i)][c] -= h;
        u[uz(i)][c] = 1.0;
        const double slope =
            (edge_volume_energy(m, above) - edge_volume_energy(m, below)) / (2.0 * h);
        EXPECT_NEAR(force[c], -slope, 1e-5 * (1.0 + force.norm()));
        EdgeState more, less;
        compute_edge_state(m, above, more);
        compute_edge_state(m, below, less);
        std::vector<Mat3> change;
        compute_edge_stress_change(m, at, u, change);
        for (std::size_t e = 0; e < change.size(); ++e) {
          const Mat3 expected = (more.stress[e] - less.stress[e]) / (2.0 * h);
          EXPECT_LE((change[e] - expected).norm(), 1e-5 * (expected.norm() + 0.1));
        }
      }
    }
  }
}

TEST(EdgeVolume, RowSumsBoundTheBlocks) {
  const Model m = jittered_box(0.3);
  const std::vector<Vec3> x = test::shaken(m.rest_position, 0.02);
  EdgeState at;
  compute_edge_state(m, x, at);
  std::vector<double> bound(x.size(), 0.0), sums(x.size(), 0.0);
  add_edge_row_sums(m, x, bound);
  for (Index e = 0; e < m.edge_cells.count(); ++e) {
    const EdgeTangent tangent(m, at, e);
    const Range slots = m.edge_cells.slots(e);
    for (auto a = uz(slots.begin); a < uz(slots.end); ++a) {
      for (auto b = uz(slots.begin); b < uz(slots.end); ++b) {
        const Mat3 block = tangent.block(m.edge_cells.gradient[a], m.edge_cells.gradient[b]);
        sums[uz(m.edge_cells.node[a])] += block.operatorNorm();
      }
    }
  }
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_LE(sums[i], bound[i]);
}

}  // namespace
}  // namespace sinew
