#include "sinew/forces/volume.h"

#include <gtest/gtest.h>

#include "sinew/base/random.h"
#include "sinew/forces/assemble.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

Model soft_box() {
  Model m = test::tissue_box(Material{}, {3, 3, 3});
  finish(m);
  return m;
}

std::vector<Vec3> shaken(const Model& m, double size) {
  std::vector<Vec3> x = m.rest_position;
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += size * (random_point(i) - Vec3::Constant(0.5));
  return x;
}

TEST(Volume, TheSmallerResultsAreTheSameToTheBit) {
  const Model m = soft_box();
  const std::vector<Vec3> x = shaken(m, 0.01);
  const TetState all = compute_tet_state(m, x);
  EXPECT_EQ(all.volume, volumes_of_tets(m, x));
  EXPECT_EQ(all.pressure, pressures_of_tets(m, x));
  EXPECT_EQ(all.gradient, compute_tet_volumes(m, x).gradient);
  // Whatever arrays are given to be used again.
  EXPECT_EQ(all.pressure, compute_tet_state(m, x, compute_tet_state(m, m.rest_position)).pressure);
}

TEST(Volume, LowTetsAreThoseWithoutHalfOfTheirVolume) {
  const Model m = soft_box();
  EXPECT_TRUE(find_low_tets(m, m.rest_position).empty());
  EXPECT_EQ(guard_frequency2(m, {}), 0.0);
  std::vector<Vec3> x = m.rest_position;
  for (Vec3& p : x) p.y() *= p.x() > 0.0 ? 0.45 : 0.55;
  const TetVolumes tets = compute_tet_volumes(m, x);
  std::vector<Index> expected;
  for (std::size_t t = 0; t < m.tets.size(); ++t)
    if (tets.volume[t] < 0.5 * m.rest_volume[t]) expected.push_back(static_cast<Index>(t));
  ASSERT_FALSE(expected.empty());
  ASSERT_LT(expected.size(), m.tets.size());
  std::vector<LowTet> low;
  find_low_tets(m, tets, low);
  const std::vector<LowTet> same = find_low_tets(m, x);
  ASSERT_EQ(low.size(), expected.size());
  ASSERT_EQ(same.size(), expected.size());
  for (std::size_t k = 0; k < low.size(); ++k) {
    EXPECT_EQ(low[k].tet, expected[k]);
    EXPECT_EQ(same[k].tet, expected[k]);
    EXPECT_EQ(same[k].volume, low[k].volume);
    EXPECT_EQ(same[k].gradient, low[k].gradient);
  }
  EXPECT_GT(guard_frequency2(m, low), 0.0);  // about to come under the guard: 0.45 < 0.4 + 0.1
}

// sum_c w_c dV_c(u) is what the pressures of the weights do along u.
TEST(Volume, RatesAndPressuresOfCellsAreAdjoint) {
  const Model m = soft_box();
  ASSERT_GT(m.cell_count(), 0);
  const TetVolumes tets = compute_tet_volumes(m, shaken(m, 0.01));
  std::vector<Vec3> u;
  for (std::size_t i = 0; i < m.rest_position.size(); ++i) u.push_back(random_point(100 + i));
  std::vector<double> weight, rate(m.cell_volume.size()), of_tets;
  for (std::size_t c = 0; c < rate.size(); ++c) weight.push_back(random_point(900 + c).x());
  rate_cells(m, tets, u, of_tets, rate);
  double by_cells = 0.0;
  for (std::size_t c = 0; c < rate.size(); ++c) by_cells += weight[c] * rate[c];
  press_cells(m, weight, of_tets);
  double by_nodes = 0.0;
  for (Index i = 0; i < m.node_count(); ++i)
    by_nodes += press_tets(m, tets.gradient, of_tets, i).dot(u[uz(i)]);
  EXPECT_NEAR(by_nodes, by_cells, 1e-12 * std::abs(by_cells));
}

}  // namespace
}  // namespace sinew
