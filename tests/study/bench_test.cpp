#include "sinew/study/bench.h"

#include <gtest/gtest.h>

#include <atomic>

#include "sinew/base/error.h"
#include "sinew/study/bench_cases.h"

namespace sinew::study {
namespace {

TEST(Bench, SameStateOnAnyNumberOfThreads) {
  BenchOptions options;
  options.meshes = {2};
  options.threads = {1, 2};
  options.filter = {"network frame W(2) single"};
  options.seconds = 0.0;
  std::vector<std::string> names;
  options.on_progress = [&](int, int, const std::string& name) { names.push_back(name); };
  const BenchResult result = run_bench(options);
  ASSERT_EQ(result.rows.size(), 2u);
  EXPECT_EQ(result.limits.size(), 2u);
  EXPECT_EQ(result.rows[0].hash, result.rows[1].hash);
  EXPECT_EQ(result.rows[1].threads, 2);
  EXPECT_GT(result.rows[0].steps, 1);
  EXPECT_EQ(result.rows[0].items, static_cast<double>(160 * result.rows[0].steps));
  EXPECT_GT(result.rows[0].share(), 0.0);
  const std::vector<std::string> expected = {
      "limits of the machine, 1 thread", "limits of the machine, 2 threads",
      "network frame W(2) single, 1 thread", "network frame W(2) single, 2 threads", ""};
  EXPECT_EQ(names, expected);
}

TEST(Bench, EveryCaseRuns) {
  BenchSubject subject(1);
  TimerOptions options;
  options.seconds = 0.0;
  options.most_in_batch = 1;
  for (const BenchCase& what : bench_cases()) {
    const auto row = subject.run(what, options);
    ASSERT_TRUE(row) << what.name();
    EXPECT_EQ(row->tets, 20);
    EXPECT_GT(row->items, 0.0) << what.name();
  }
}

TEST(Bench, StopsAndRefuses) {
  std::atomic<bool> stop{true};
  BenchOptions options;
  options.meshes = {1};
  options.stop = &stop;
  const BenchResult result = run_bench(options);
  EXPECT_TRUE(result.stopped);
  EXPECT_TRUE(result.rows.empty());
  options.filter = {"steep"};
  EXPECT_THROW(run_bench(options), Error);
}

}  // namespace
}  // namespace sinew::study
