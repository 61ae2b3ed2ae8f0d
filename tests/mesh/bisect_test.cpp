#include "sinew/mesh/bisect.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "sinew/base/random.h"

namespace sinew {
namespace {

TEST(Bisect, PartsHoldEveryPointOnceAndAtMostTheGivenNumber) {
  std::vector<Vec3> x;
  for (std::uint64_t i = 0; i < 1000; ++i) x.push_back(random_point(i));
  std::vector<Index> points(x.size());
  std::iota(points.begin(), points.end(), 0);
  const auto parts = bisect(x, points, 70);
  const Index* next = points.data();
  for (const auto& part : parts) {
    EXPECT_LE(part.size(), 70u);
    EXPECT_GE(part.size(), 35u);
    EXPECT_EQ(part.data(), next);  // contiguous, in order
    next += part.size();
  }
  EXPECT_EQ(next, points.data() + points.size());
  std::sort(points.begin(), points.end());
  for (Index i = 0; i < 1000; ++i) EXPECT_EQ(points[uz(i)], i);
}

TEST(Bisect, DividesAcrossTheLongestSide) {
  std::vector<Vec3> x;
  for (int i = 0; i < 8; ++i) x.emplace_back(0.1 * (i % 2), 0.0, 1.0 * (7 - i));
  std::vector<Index> points = {0, 1, 2, 3, 4, 5, 6, 7};
  const auto parts = bisect(x, points, 4);
  ASSERT_EQ(parts.size(), 2u);
  for (const Index i : parts[0]) EXPECT_LT(x[uz(i)].z(), 3.5);
  for (const Index i : parts[1]) EXPECT_GT(x[uz(i)].z(), 3.5);
}

TEST(Bisect, NothingHasNoParts) {
  EXPECT_TRUE(bisect({}, {}, 4).empty());
}

}  // namespace
}  // namespace sinew
