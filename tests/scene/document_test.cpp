#include "sinew/scene/document.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/scene/support.h"

namespace sinew {
namespace {

using test::error_of;

TEST(Document, KeepsTheOrderOfTheFileAndThePlaces) {
  const DocValue root = parse_document("z = 1\na = 2.5\n[body.second]\n[body.first]\n", "f.toml");
  ASSERT_EQ(root.entries.size(), 3U);
  EXPECT_EQ(root.entries[0].key, "z");
  EXPECT_EQ(root.entries[1].key, "a");
  EXPECT_EQ(root.entries[1].value.where.line, 2);
  EXPECT_EQ(root.entries[1].value.where.column, 5);
  EXPECT_EQ(root.entries[1].where.column, 1);
  const DocValue* body = root.find("body");
  ASSERT_NE(body, nullptr);
  EXPECT_EQ(body->entries[0].key, "second");
  EXPECT_EQ(body->entries[1].key, "first");
  EXPECT_EQ(root.find("missing"), nullptr);
}

TEST(Document, WritesWhatReadsTheSame) {
  const std::string text =
      "title = \"a \\\"quoted\\\" \\\\ text\\nof two lines, \\u0001 and \u00e9\"\n"
      "whole = 3\n"
      "tenth = 0.1\n"
      "big = 1e+300\n"
      "small = 4.9406564584124654e-324\n"
      "round = 15000.0\n"
      "endless = inf\n"
      "yes = true\n"
      "list = [1, 2.5, [true], { \"odd key\" = \"x\" }]\n"
      "\n[body.second]\n"
      "\n[body.second.region.r]\nlabel = 1\n"
      "\n[body.first]\nx = 1\n"
      "\n[ground]\n";
  const std::string once = write_document(parse_document(text, "f.toml"));
  EXPECT_EQ(write_document(parse_document(once, "f.toml")), once);
  const DocValue root = parse_document(once, "f.toml");
  EXPECT_EQ(root.find("title")->text, "a \"quoted\" \\ text\nof two lines, \x01 and \u00e9");
  EXPECT_EQ(root.find("whole")->type, DocValue::Type::integer);
  EXPECT_EQ(root.find("tenth")->number, 0.1);
  EXPECT_EQ(root.find("round")->type, DocValue::Type::number);
  EXPECT_EQ(root.find("small")->number, std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(root.find("list")->items[3].entries[0].key, "odd key");
  EXPECT_EQ(root.find("body")->entries[0].key, "second");
  EXPECT_TRUE(root.find("ground")->entries.empty());
}

TEST(Document, RefusesWhatIsTooDeep) {
  std::string dots = "a";
  for (int i = 0; i < 100000; ++i) dots += ".a";
  EXPECT_EQ(error_of([&] { parse_document("x = 1\n" + dots + " = 1\n", "f.toml"); }),
            "f.toml:2:66: nested more than 32 deep\n"
            "  remedy: no key of a scene needs that: see docs/scene-format.md");
  EXPECT_NE(error_of([&] { parse_document("x = " + std::string(100000, '['), "f.toml"); }), "");
  EXPECT_EQ(error_of([&] { parse_document("x = \"" + std::string(100, '[') + "\"", "f.toml"); }),
            "");
  EXPECT_EQ(error_of([&] { parse_document("# " + std::string(100, '[') + "\n", "f.toml"); }), "");
}

TEST(Document, RefusesWhatIsTooLong) {
  EXPECT_EQ(error_of([] { parse_document(std::string(5 << 20, '\n'), "f.toml"); }),
            "f.toml: 5242880 bytes: a scene has at most 4194304\n"
            "  remedy: is this a scene? meshes belong into files of their own");
}

TEST(Document, RefusesDates) {
  EXPECT_EQ(error_of([] { parse_document("title = 2020-01-01\n", "f.toml"); }),
            "f.toml:1:9: a date or a time: no key of a scene takes one\n"
            "  remedy: put it in quotes if it is meant as text");
}

TEST(Document, DescribesLongTextsInPart) {
  const DocValue root = parse_document("x = \"" + std::string(100, 'a') + "\"", "f.toml");
  EXPECT_EQ(describe(*root.find("x")), "\"" + std::string(56, 'a') + "...");
}

}  // namespace
}  // namespace sinew
