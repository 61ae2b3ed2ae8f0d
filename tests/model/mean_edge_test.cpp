#include "sinew/model/mean_edge.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sinew {
namespace {

TEST(MeanEdge, OfARegularTetInvertsItsVolume) {
  EXPECT_NEAR(regular_tet_edge(0.3 * 0.3 * 0.3 / (6 * std::sqrt(2.0))), 0.3, 1e-15);
}

TEST(MeanEdge, OfTetsOrElseOfSpringsOrElseZero) {
  Model m;
  EXPECT_EQ(mean_edge(m), 0.0);
  m.springs = {{0, 1}, {1, 2}};
  m.rest_length = {0.1, 0.3};
  EXPECT_DOUBLE_EQ(mean_edge(m), 0.2);
  m.tets = {{0, 1, 2, 3}, {1, 2, 3, 4}};
  m.rest_volume = {1e-6, 3e-6};
  EXPECT_DOUBLE_EQ(mean_edge(m), regular_tet_edge(2e-6));
}

}  // namespace
}  // namespace sinew
