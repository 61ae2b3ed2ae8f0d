#include "sinew/io/text_reader.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sinew::io {
namespace {

TEST(TextReader, NumbersInAllTheirForms) {
  TextReader r("1 -2 +3 .5 -1e-3 +2.5E+2 nan -inf 1e-400 7", "f", '#');
  EXPECT_EQ(r.integer({"a"}), 1);
  EXPECT_EQ(r.integer({"a"}), -2);
  EXPECT_EQ(r.integer({"a"}), 3);
  EXPECT_EQ(r.real({"a"}), 0.5);
  EXPECT_EQ(r.real({"a"}), -1e-3);
  EXPECT_EQ(r.real({"a"}), 250);
  EXPECT_TRUE(std::isnan(r.real({"a"})));
  EXPECT_EQ(r.real({"a"}), -INFINITY);
  EXPECT_EQ(r.real({"a"}), 0);  // smaller than any double
  EXPECT_EQ(r.label({"a"}), 7);
  EXPECT_TRUE(r.at_end());
}

TEST(TextReader, BlanksCommentsAndLineEnds) {
  TextReader r("\xEF\xBB\xBF# first\r\n\r\n a # b\r\n\t c#d\n", "f", '#');
  EXPECT_EQ(r.word({"w"}), "a");
  EXPECT_TRUE(r.at_line_end());
  EXPECT_EQ(r.peek(), "c");
  EXPECT_EQ(r.word({"w"}), "c");
  EXPECT_TRUE(r.at_end());
  TextReader no_comments("a #b", "f", 0);
  no_comments.word({"w"});
  EXPECT_EQ(no_comments.word({"w"}), "#b");
}

std::string message(void (*read)(TextReader&), std::string_view text) {
  TextReader r(text, "f", '#');
  try {
    read(r);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(TextReader, ErrorsSayWhereWhatAndWhatToDo) {
  const auto second_real = [](TextReader& r) {
    r.set_part("a line", "x y");
    r.real({"x", "vertex", 3});
    r.real({"y", "vertex", 3});
  };
  EXPECT_EQ(
      message(second_real, "# c\n 1\n   1.5mm 3"),
      "f:3:4: expected y of vertex 3 (a number), found \"1.5mm\"\n  remedy: a line is written: "
      "x y; check this entry and the count before it");
  EXPECT_EQ(
      message(second_real, "1\n"),
      "f:2:1: the file ends where y of vertex 3 was expected\n  remedy: the file was cut short "
      "or its count is too large: fetch it again, or correct the count");
  for (const char* bad : {"1 +-2", "1 +", "1 -", "1 0x10", "1 1,5", "1 1e", "1 --1"}) {
    EXPECT_NE(message(second_real, bad).find("expected y of vertex 3"), std::string::npos) << bad;
  }
  const auto integer = [](TextReader& r) { r.integer({"id"}); };
  for (const char* bad : {"1.0", "1e3", "99999999999999999999", "x", "\x01\xff"}) {
    EXPECT_NE(message(integer, bad).find("expected id (a whole number)"), std::string::npos) << bad;
  }
  EXPECT_NE(message(integer, "\x01\xff").find("found \"\\x01\\xff\""), std::string::npos);
  EXPECT_NE(message(integer, std::string(1000, 'q')).find("q...\""), std::string::npos);
}

TEST(TextReader, CountsMustFitInTheRestOfTheText) {
  const auto count = [](TextReader& r) { EXPECT_EQ(r.count({"the number of pairs"}, 2), 2U); };
  EXPECT_EQ(message(count, "2 1 2 3 4"), "no error");
  EXPECT_NE(message(count, "3 1 2 3 4").find("cannot hold more than 2"), std::string::npos);
  EXPECT_NE(message(count, "9223372036854775807 1").find("cannot hold more"), std::string::npos);
  EXPECT_NE(message(count, "-1").find("0 or more was expected"), std::string::npos);
}

TEST(TextReader, RawBytesAfterALine) {
  TextReader r("3 \r\nab\ncd e", "f", 0);
  r.integer({"n"});
  r.end_line({"n"});
  EXPECT_EQ(r.take(5, {"bytes"}), "ab\ncd");
  EXPECT_EQ(r.remaining(), 2U);
  EXPECT_THROW(r.take(3, {"bytes"}), Error);
  r.set_binary();
  try {
    r.take(3, {"bytes"});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.location().line, 0);
    EXPECT_EQ(error.message(), "the file ends where bytes was expected (at byte 9)");
  }
}

}  // namespace
}  // namespace sinew::io
