#include "sinew/study/bench.h"

#include <gtest/gtest.h>

#include <atomic>

#include "sinew/base/error.h"
#include "sinew/scene/build.h"
#include "sinew/study/bench_cases.h"

namespace sinew::study {
namespace {

MachineLimits limits(int threads) {
  MachineLimits m;
  m.threads = threads;
  m.level = {Bandwidth{1e6, 40e9, 50e9}, Bandwidth{16e6, 20e9, 18e9}, Bandwidth{4e8, 10e9, 9e9}};
  m.flops = 100e9;
  m.clock = 2e9;
  m.fma_per_cycle = 2.0;
  return m;
}

constexpr CacheSizes caches{1e6, 30e6};

Model bar(const std::string& law) {
  return build_model(parse_scene("[body.b]\nshape = \"beam\"\ncells = [1, 1, 4]\nlaw = \"" + law +
                                     "\"\n[pin.p]\nselect = { side = \"-z\" }\n",
                                 "bar", "."));
}

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

TEST(BenchMachine, LevelThatHoldsTheWork) {
  EXPECT_EQ(level_of(caches, 0.9e6, 1), MemoryLevel::l2);
  EXPECT_EQ(level_of(caches, 1.1e6, 1), MemoryLevel::l3);
  EXPECT_EQ(level_of(caches, 1.1e6, 2), MemoryLevel::l2);  // half of it on each core
  EXPECT_EQ(level_of(caches, 31e6, 2), MemoryLevel::memory);
  const CacheSizes here = cache_sizes();
  EXPECT_GT(here.l2, 0.0);
  EXPECT_GT(here.l3, here.l2);
}

TEST(BenchWork, BoundIsTheLongerOfMovingAndComputing) {
  const Bound l2 = bound_of({5e5, 1e5, 5e5}, caches, limits(1));
  EXPECT_STREQ(l2.by, "L2");
  EXPECT_DOUBLE_EQ(l2.seconds, 5e5 / 50e9);  // the better of copy and triad
  const Bound memory = bound_of({1e8, 1e6, 5e7}, caches, limits(1));
  EXPECT_STREQ(memory.by, "memory");
  EXPECT_DOUBLE_EQ(memory.seconds, 1e8 / 10e9);
  const Bound computing = bound_of({5e5, 1e7, 5e5}, caches, limits(1));
  EXPECT_STREQ(computing.by, "FMA");
  EXPECT_DOUBLE_EQ(computing.seconds, 1e7 / 100e9);

  BenchRow row;
  row.time.median = 1e-3;
  row.items = 1000.0;
  row.work = {1e6, 0.0, 1e6};
  row.bound = {"L2", 4e-4};
  EXPECT_DOUBLE_EQ(row.ns_per_item(), 1e3);
  EXPECT_DOUBLE_EQ(row.bandwidth(), 1e9);
  EXPECT_DOUBLE_EQ(row.share(), 0.4);
}

TEST(BenchWork, SumsAndRepeats) {
  const Work sum = Work{1.0, 2.0, 3.0} + Work{10.0, 20.0, 30.0};
  EXPECT_EQ(sum.bytes, 11.0);
  EXPECT_EQ(sum.flops, 22.0);
  EXPECT_EQ(sum.working_set, 33.0);
  const Work thrice = 3.0 * sum;
  EXPECT_EQ(thrice.bytes, 33.0);
  EXPECT_EQ(thrice.working_set, 33.0);  // the same arrays
}

TEST(BenchWork, BytesOfSprings) {
  const Model m = bar("lloyd");
  const double nodes = m.node_count(), springs = m.spring_count();
  // Ends, k, l0 and c, the force; positions and velocities.
  EXPECT_EQ(springs_work(m).bytes, springs * (8 + 24 + 24) + nodes * 48);
  EXPECT_EQ(springs_work(m).working_set, springs_work(m).bytes);
  // Single precision: an end and a quarter in two bytes each, seven constants in four. No tets.
  EXPECT_DOUBLE_EQ(forces_work(m, Precision::single).bytes,
                   springs * (2.5 + 28) + nodes * (24 + 24 + 16 + 24 + 16 + 16));
}

TEST(BenchWork, BytesOfTets) {
  const Model m = bar("neo-hookean");
  const double nodes = m.node_count(), tets = m.tet_count(), cells = m.cell_count();
  double springs = 0.0;
  for (const Range& active : m.active_springs) springs += active.size();
  const Work single = forces_work(m, Precision::single);
  EXPECT_DOUBLE_EQ(single.bytes, nodes * (24 + 24 + 16 + 24 + 16 + 16) + cells * 8 +
                                     2.0 * tets * (34 + 4) + springs * 30.5);
  // The second pass over the tets reads what the first has read again.
  EXPECT_DOUBLE_EQ(single.bytes - single.working_set, tets * (34 + 4));
  const double entries = static_cast<double>(m.network_node.size());
  EXPECT_DOUBLE_EQ(gather_work(m, Precision::single).bytes,
                   entries * 0.8 * 12 + nodes * (20 + 16 + 24));
  const Work step = step_work(m, Precision::double_);
  EXPECT_EQ(step.bytes, forces_work(m, Precision::double_).bytes +
                            gather_work(m, Precision::double_).bytes + update_work(m).bytes);
  EXPECT_GT(product_work(m).bytes, 0.0);
  EXPECT_GT(iteration_work(m).bytes, product_work(m).bytes);
  EXPECT_EQ(iteration_work(m).bytes - product_work(m).bytes, nodes * (48 + 48 + 80 + 48));
}

BenchResult made_up() {
  BenchResult result;
  result.machine = {"a processor", "AVX2", 8, 2, caches};
  result.limits = {limits(1)};
  BenchRow row;
  row.kernel = "network step";
  row.mesh = "W(8)";
  row.precision = "single";
  row.nodes = 2673;
  row.tets = 10240;
  row.springs = 14064;
  row.time = {2e-4, 1.9e-4, 0.01, 12, 10};
  row.unit = "tet";
  row.items = 10240;
  row.work = {4e6, 3e6, 3e6};
  row.bound = bound_of(row.work, caches, result.limits[0]);
  row.hash = "0123456789abcdef";
  row.steps = 1;
  result.rows = {row};
  return result;
}

TEST(BenchReport, Json) {
  const nlohmann::ordered_json json = to_json(made_up());
  EXPECT_EQ(json["schema"], 1);
  for (const char* key : {"version", "machine", "limits", "stopped", "rows"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  const auto& limit = json["limits"][0];
  EXPECT_EQ(limit["bandwidth"]["L3"]["copy"], 20e9);
  EXPECT_EQ(limit["fma_per_cycle"], 2.0);
  const auto& row = json["rows"][0];
  EXPECT_EQ(row["ns_per_item"], 2e5 / 10240);
  EXPECT_EQ(row["bound"], "L3");
  EXPECT_DOUBLE_EQ(row["share_of_bound"], 4e6 / 20e9 / 2e-4);
  EXPECT_EQ(row["time"]["repetitions"], 12);
}

TEST(BenchReport, RowsOfAnotherProgram) {
  const auto rows = rows_from_json(nlohmann::json::parse(to_json(made_up()).dump()), "peer");
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].kernel, "network step");
  EXPECT_EQ(rows[0].time.median, 2e-4);
  EXPECT_EQ(rows[0].springs, 14064);
  EXPECT_EQ(rows[0].share(), 0.0);  // its work is not known
  try {
    rows_from_json(nlohmann::json::parse("{\"rows\": [{}]}"), "peer");
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::input);
    EXPECT_NE(std::string(e.what()).find("peer: not what sinew bench writes"), std::string::npos);
  }
}

TEST(BenchReport, Text) {
  const std::string text = to_text(made_up());
  for (const char* word : {"a processor, 2 cores, AVX2 (8 floats)", "19.5", "100 %", "L3",
                           "0123456789abcdef", "2.00 vector multiply-adds a cycle"}) {
    EXPECT_NE(text.find(word), std::string::npos) << word << " in\n" << text;
  }
}

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
