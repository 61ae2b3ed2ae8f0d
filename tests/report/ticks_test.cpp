#include "sinew/report/ticks.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sinew::report {
namespace {

using Labels = std::vector<std::string>;

TEST(LinearTicks, AreRoundNumbersWithinTheRange) {
  EXPECT_EQ(linear_ticks(0.0, 1.0, 5).labels, (Labels{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  EXPECT_EQ(linear_ticks(-12.0, 21.0, 7).labels, (Labels{"−10", "−5", "0", "5", "10", "15", "20"}));
  EXPECT_EQ(linear_ticks(9990.0, 10012.0, 5).labels,
            (Labels{"9990", "9995", "10000", "10005", "10010"}));
}

TEST(LinearTicks, UsePowersOfTenWhereNumbersAreLargeOrSmall) {
  EXPECT_EQ(linear_ticks(0.0, 3e6, 3).labels, (Labels{"0", "1·10⁶", "2·10⁶", "3·10⁶"}));
  EXPECT_EQ(linear_ticks(-1e-5, 1.1e-5, 5).labels,
            (Labels{"−1.0·10⁻⁵", "−0.5·10⁻⁵", "0", "0.5·10⁻⁵", "1.0·10⁻⁵"}));
}

TEST(LinearTicks, FitAnyRange) {
  for (int e = -290; e <= 290; e += 7)
    for (const double offset : {0.0, -0.3, 1.0, 1000.0}) {
      const double size = 3.7 * std::pow(10.0, e);
      const double low = offset * size;
      const double high = low + size;
      const Ticks ticks = linear_ticks(low, high);
      ASSERT_GE(ticks.at.size(), 2U) << low << " " << high;
      EXPECT_LE(ticks.at.size(), 9U);
      ASSERT_EQ(ticks.at.size(), ticks.labels.size());
      for (std::size_t i = 0; i < ticks.at.size(); ++i) {
        EXPECT_GE(ticks.at[i], low - 1e-6 * size);
        EXPECT_LE(ticks.at[i], high + 1e-6 * size);
        if (i > 0) {
          EXPECT_LT(ticks.at[i - 1], ticks.at[i]);
          EXPECT_NE(ticks.labels[i - 1], ticks.labels[i]) << low << " " << high;
        }
      }
    }
}

TEST(LogTicks, ArePowersOfTen) {
  EXPECT_EQ(log_ticks(0.001, 1.0).labels, (Labels{"0.001", "0.01", "0.1", "1"}));
  EXPECT_EQ(log_ticks(1e-9, 2e-5).labels, (Labels{"10⁻⁹", "10⁻⁸", "10⁻⁷", "10⁻⁶", "10⁻⁵"}));
  EXPECT_EQ(log_ticks(1e3, 1e6).labels, (Labels{"10³", "10⁴", "10⁵", "10⁶"}));
}

TEST(LogTicks, HaveTwoAndFiveInShortRanges) {
  EXPECT_EQ(log_ticks(0.9, 60.0).labels, (Labels{"1", "2", "5", "10", "20", "50"}));
  EXPECT_EQ(log_ticks(4e-7, 3e-6).labels, (Labels{"5·10⁻⁷", "10⁻⁶", "2·10⁻⁶"}));
}

TEST(LogTicks, AreLinearInARangeWithoutThree) {
  EXPECT_EQ(log_ticks(10.5, 12.5, 4).labels, (Labels{"10.5", "11.0", "11.5", "12.0", "12.5"}));
}

TEST(LogTicks, AreThinnedInLongRanges) {
  const Ticks ticks = log_ticks(1e-280, 1e280);
  EXPECT_LE(ticks.at.size(), 9U);
  EXPECT_GE(ticks.at.size(), 5U);
}

}  // namespace
}  // namespace sinew::report
