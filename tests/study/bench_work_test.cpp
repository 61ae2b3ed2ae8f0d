#include "sinew/study/bench_work.h"

#include <gtest/gtest.h>

#include "sinew/scene/build.h"
#include "sinew/study/bench.h"
#include "tests/study/made_up_machine.h"

namespace sinew::study {
namespace {

using test::caches;
using test::limits;

Model bar(const std::string& law) {
  return build_model(parse_scene("[body.b]\nshape = \"beam\"\ncells = [1, 1, 4]\nlaw = \"" + law +
                                     "\"\n[pin.p]\nselect = { side = \"-z\" }\n",
                                 "bar", "."));
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
                                     2.0 * tets * (34 + 4) + springs * 30.5 +
                                     m.edge_cells.count() * 12.0 +
                                     static_cast<double>(m.edge_cells.node.size()) * 14.0);
  // The second pass over the tets reads what the first has read again.
  EXPECT_DOUBLE_EQ(single.bytes - single.working_set, tets * (34 + 4));
  EXPECT_DOUBLE_EQ(gather_work(m, Precision::single).bytes, nodes * (20 + 16 + 24));
  const Work step = step_work(m, Precision::double_);
  EXPECT_EQ(step.bytes, forces_work(m, Precision::double_).bytes +
                            gather_work(m, Precision::double_).bytes + update_work(m).bytes);
  EXPECT_GT(product_work(m).bytes, 0.0);
  EXPECT_GT(iteration_work(m).bytes, product_work(m).bytes);
  EXPECT_EQ(iteration_work(m).bytes - product_work(m).bytes, nodes * (48 + 48 + 80 + 48));
}

}  // namespace
}  // namespace sinew::study
