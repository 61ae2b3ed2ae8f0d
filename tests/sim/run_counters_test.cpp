#include "sinew/sim/run_counters.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include "tests/support/source_dir.h"

namespace sinew {
namespace {

TEST(RunCounters, AddUpReportsAsTheListSays) {
  RunCounters c;
  StepReport first;
  first.newton = 3;
  first.residual = 1e-3;
  first.contacts = 5;
  first.deepest = 2e-4;
  first.limits_met = false;
  StepReport second;
  second.newton = 4;
  second.residual = 1e-7;
  second.contacts = 2;
  second.deepest = 1e-4;
  c.step_reductions = 7;  // counted elsewhere
  c.add(first);
  c.add(second);
  EXPECT_EQ(c.newton_steps, 7);
  EXPECT_EQ(c.residual, 1e-3);
  EXPECT_EQ(c.contacts, 2);
  EXPECT_EQ(c.deepest, 2e-4);
  EXPECT_EQ(c.depth, 1e-4);
  EXPECT_EQ(c.unmet_limits, 1);
  EXPECT_EQ(c.step_reductions, 7);
}

// Names and keys are each there once, and docs/output.md has every key.
TEST(RunCounters, AreDocumented) {
  std::ifstream page(test::source_path("docs/output.md"));
  std::stringstream text;
  text << page.rdbuf();
  const RunCounters c;
  std::set<std::string> names, keys;
  for_each_counter(c, [&](const CounterField& field, const auto&) {
    EXPECT_TRUE(names.insert(std::string(field.name)).second) << field.name;
    if (field.key.empty()) return;
    EXPECT_TRUE(keys.insert(std::string(field.key)).second) << field.key;
    const std::string key(field.key.substr(field.key.find('/') + 1));
    EXPECT_NE(text.str().find("`" + key + "`"), std::string::npos) << field.key;
    EXPECT_FALSE(field.meaning.empty());
  });
}

}  // namespace
}  // namespace sinew
