#include "sinew/scene/keys.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "sinew/model/material.h"
#include "sinew/scene/scene.h"
#include "tests/scene/support.h"
#include "tests/support/source_dir.h"

namespace sinew {
namespace {

std::string scene_format() {
  std::ifstream in(test::source_path("docs/scene-format.md"));
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::string default_text(const Key& key) {
  if (key.default_value.empty()) return " ";
  if (key.default_value.starts_with("the ")) return fmt::format(" {} ", key.default_value);
  return fmt::format(" `{}` ", key.default_value);
}

std::string cell(std::string_view text) {
  return text.empty() ? " " : fmt::format(" {} ", text);
}

// The row of a key without its meaning: "| `young` | a number | Pa | `15e3` | > 0 |".
std::string row(const Key& key) {
  return fmt::format("| `{}` |{}|{}|{}|{}|", key.name, cell(type_text(key)), cell(key.unit),
                     default_text(key), cell(key.range.text()));
}

TEST(Keys, StandInTheDocument) {
  const std::string document = scene_format();
  ASSERT_FALSE(document.empty());
  for (const KeyTable* table : key_tables().all())
    for (const Key& key : table->keys)
      EXPECT_NE(document.find(fmt::format("\n{} ", row(key))), std::string::npos)
          << "docs/scene-format.md has no row for " << table->title << ":\n"
          << row(key);
}

TEST(Keys, HaveAMeaningInTheDocument) {
  std::istringstream lines(scene_format());
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("| `")) continue;
    EXPECT_FALSE(line.ends_with("| |") || line.ends_with("||")) << line;
  }
}

TEST(Keys, AreUniqueInTablesReadTogether) {
  const KeyTables& t = key_tables();
  using Group = std::vector<const KeyTable*>;
  for (const Group& group :
       {Group{&t.body, &t.material}, Group{&t.region, &t.material}, Group{&t.pin, &t.motion},
        Group{&t.attachment, &t.motion}, Group{&t.obstacle, &t.motion}}) {
    std::set<std::string_view> names;
    for (const KeyTable* table : group)
      for (const Key& key : table->keys) EXPECT_TRUE(names.insert(key.name).second) << key.name;
  }
}

// The defaults that the tables state are those that a scene without the keys has.
TEST(Keys, StateTheDefaultsThatHold) {
  const std::string minimal =
      "[body.b]\nshape = \"beam\"\n[body.c]\nshape = \"beam\"\n[ground]\n[output]\n"
      "[force.f]\nbody = \"b\"\nselect = { all = true }\nforce = [0, 0, 0]\n"
      "[attachment.a]\nbody = \"b\"\nselect = { all = true }\nto_body = \"c\"\n";
  const Scene plain = test::parse(minimal);
  const auto check = [&](const KeyTable& table, const std::string& path) {
    for (const Key& key : table.keys) {
      const bool stated = !key.default_value.empty() && !key.default_value.starts_with("the ");
      const bool of_other_shape =
          path == "b." && (key.name == "radius" || key.name == "radii" || key.name == "height" ||
                           key.name == "resolution" || key.name == "inner_radius");
      if (!stated || of_other_shape) continue;
      const std::string set = fmt::format("{}{}={}", path, key.name, key.default_value);
      const Scene explicitly = test::parse(minimal, {set});
      EXPECT_NE(explicitly.document, plain.document) << set;
      EXPECT_EQ(build_model(explicitly).hash(), build_model(plain).hash()) << set;
    }
  };
  check(key_tables().scene, "");
  check(key_tables().body, "b.");
  check(key_tables().material, "b.");
  check(key_tables().force, "f.");
  check(key_tables().attachment, "a.");
  check(key_tables().ground, "ground.");
}

TEST(Interval, SaysAndChecksItsEnds) {
  const Interval open{0.0, 1.0, true, true};
  EXPECT_EQ(open.text(), "in (0, 1)");
  EXPECT_FALSE(open.contains(0.0));
  EXPECT_TRUE(open.contains(0.5));
  EXPECT_FALSE(open.contains(1.0));
  const Interval closed{0.0, 1.0};
  EXPECT_EQ(closed.text(), "from 0 to 1");
  EXPECT_TRUE(closed.contains(0.0) && closed.contains(1.0));
  const Interval positive{0.0, std::numeric_limits<double>::infinity(), true};
  EXPECT_EQ(positive.text(), "> 0");
  EXPECT_FALSE(positive.contains(std::numeric_limits<double>::infinity()));
  EXPECT_FALSE(positive.contains(std::numeric_limits<double>::quiet_NaN()));
  Interval endless = positive;
  endless.infinity_allowed = true;
  EXPECT_EQ(endless.text(), "> 0, or inf");
  EXPECT_TRUE(endless.contains(std::numeric_limits<double>::infinity()));
  EXPECT_FALSE(endless.contains(-std::numeric_limits<double>::infinity()));
  EXPECT_EQ(Interval{}.text(), "");
}

}  // namespace
}  // namespace sinew
