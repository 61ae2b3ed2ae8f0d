#include "sinew/base/parallel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace sinew {
namespace {

TEST(Parallel, VisitsEveryItemOnce) {
  std::vector<int> visits(10'007, 0);
  parallel_for(10'007, [&](Index i) { ++visits[uz(i)]; });
  for (const int v : visits) EXPECT_EQ(v, 1);
}

TEST(Parallel, EmptyRangesDoNothing) {
  parallel_for(0, [](Index) { FAIL(); });
  EXPECT_EQ(parallel_sum(0, [](Index) { return 1.0; }), 0.0);
}

TEST(Parallel, SumsHaveTheSameBitsAtAnyThreadCount) {
  const auto term = [](Index i) { return std::sin(0.1 * i) * 1e3 / (1.0 + i); };
  std::vector<double> sums;
  for (const int threads : {1, 2, 3}) {
    const ThreadLimit limit(threads);
    sums.push_back(parallel_sum(100'000, term));
  }
  EXPECT_EQ(sums[0], sums[1]);
  EXPECT_EQ(sums[0], sums[2]);
}

TEST(Parallel, ReduceCombinesBlocksInOrder) {
  const std::vector<Index> begins = parallel_reduce(
      5000, std::vector<Index>{}, [](Range r) { return std::vector<Index>{r.begin}; },
      [](std::vector<Index> a, const std::vector<Index>& b) {
        a.insert(a.end(), b.begin(), b.end());
        return a;
      });
  EXPECT_EQ(begins, (std::vector<Index>{0, 1024, 2048, 3072, 4096}));
}

}  // namespace
}  // namespace sinew
