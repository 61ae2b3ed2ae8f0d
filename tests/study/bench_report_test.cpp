// bench_report.cpp: text and JSON of the results.
#include "sinew/study/bench.h"

#include <gtest/gtest.h>

#include "sinew/base/error.h"
#include "tests/study/made_up_machine.h"

namespace sinew::study {
namespace {

using test::caches;
using test::limits;

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

}  // namespace
}  // namespace sinew::study
