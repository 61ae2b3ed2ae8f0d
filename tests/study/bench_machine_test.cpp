#include "sinew/study/bench_machine.h"

#include <gtest/gtest.h>

#include "tests/study/made_up_machine.h"

namespace sinew::study {
namespace {

using test::caches;

TEST(BenchMachine, LevelThatHoldsTheWork) {
  EXPECT_EQ(level_of(caches, 0.9e6, 1), MemoryLevel::l2);
  EXPECT_EQ(level_of(caches, 1.1e6, 1), MemoryLevel::l3);
  EXPECT_EQ(level_of(caches, 1.1e6, 2), MemoryLevel::l2);  // half of it on each core
  EXPECT_EQ(level_of(caches, 31e6, 2), MemoryLevel::memory);
  const CacheSizes here = cache_sizes();
  EXPECT_GT(here.l2, 0.0);
  EXPECT_GT(here.l3, here.l2);
}

}  // namespace
}  // namespace sinew::study
