#include "sinew/report/text.h"
#include "tests/support/numbers.h"

#include <gtest/gtest.h>

#include <limits>

namespace sinew::report {
namespace {

using test::inf;
using test::nan;

TEST(Escaped, LeavesTextAndReplacesMarkup) {
  EXPECT_EQ(escaped("ν = 0.45, λ → ∞"), "ν = 0.45, λ → ∞");
  EXPECT_EQ(escaped("<a href=\"x\">'&'</a>"),
            "&lt;a href=&quot;x&quot;&gt;&#39;&amp;&#39;&lt;/a&gt;");
}

TEST(Escaped, ReplacesWhatXmlCannotHold) {
  const std::string bad = "\xEF\xBF\xBD";
  EXPECT_EQ(escaped(std::string("a\0b\x1b", 4)), "a" + bad + "b" + bad);
  EXPECT_EQ(escaped("a\tb\n"), "a\tb\n");
  EXPECT_EQ(escaped("\xff"), bad);
  EXPECT_EQ(escaped("\xc3"), bad);                      // cut short
  EXPECT_EQ(escaped("\xc0\xaf"), bad + bad);            // overlong
  EXPECT_EQ(escaped("\xed\xa0\x80"), bad + bad + bad);  // a surrogate
  EXPECT_EQ(escaped("\xef\xbf\xbf"), bad + bad + bad);  // U+FFFF
  EXPECT_EQ(escaped("\xf0\x9f\xab\x80"), "\xf0\x9f\xab\x80");
  EXPECT_EQ(escaped("\xf4\x90\x80\x80").substr(0, 3), bad);  // above U+10FFFF
}

TEST(Width, CountsCharacters) {
  EXPECT_EQ(width(""), 0);
  EXPECT_EQ(width("E [kPa]"), 7);
  EXPECT_EQ(width("ν 10⁻⁵"), 6);
}

TEST(Number, IsForReaders) {
  EXPECT_EQ(number(15000.0, 5), "15000");
  EXPECT_EQ(number(0.12345678), "0.1235");
  EXPECT_EQ(number(-0.0), "0");
  EXPECT_EQ(number(1.5e-7), "1.5e-07");
  EXPECT_EQ(number(nan), "-");
  EXPECT_EQ(number(-inf), "-inf");
}

TEST(Percent, HasASign) {
  EXPECT_EQ(percent(-0.165), "-16.5 %");
  EXPECT_EQ(percent(0.00066, 2), "+0.07 %");
  EXPECT_EQ(percent(nan), "-");
}

}  // namespace
}  // namespace sinew::report
