#include "sinew/study/bench_timer.h"

#include <gtest/gtest.h>

#include <atomic>

namespace sinew::study {
namespace {

TEST(BenchTimer, MedianLeastAndSpread) {
  const Timing t = timing_of({5.0, 1.0, 4.0, 2.0, 3.0}, 7);
  EXPECT_EQ(t.median, 3.0);
  EXPECT_EQ(t.min, 1.0);
  EXPECT_DOUBLE_EQ(t.spread, 2.0 / 3.0);  // quartiles 2 and 4
  EXPECT_EQ(t.repetitions, 5);
  EXPECT_EQ(t.batch, 7);
  EXPECT_EQ(timing_of({2.0, 4.0}, 1).median, 3.0);
}

TEST(BenchTimer, AtLeastFiveRepetitionsEachPrepared) {
  int prepared = 0, ran = 0;
  TimerOptions options;
  options.seconds = 0.0;
  options.most_in_batch = 4;
  const auto t = measure(
      options, [&] { ++prepared; }, [&] { ++ran; });
  ASSERT_TRUE(t);
  EXPECT_EQ(t->repetitions, 5);
  EXPECT_EQ(t->batch, 4);
  EXPECT_EQ(prepared, 5 + 3);  // 1, 2 and 4 to warm up
  EXPECT_EQ(ran, 5 * 4 + 1 + 2 + 4);
}

TEST(BenchTimer, Stops) {
  std::atomic<bool> stop{false};
  TimerOptions options;
  options.stop = &stop;
  int ran = 0;
  const auto t = measure(
      options, [] {}, [&] { stop = ++ran == 3; });
  EXPECT_FALSE(t);
  EXPECT_LE(ran, 4);
}

}  // namespace
}  // namespace sinew::study
