#include "sinew/run/force_curve.h"

#include <gtest/gtest.h>

namespace sinew {
namespace {

TEST(ForceCurve, HasAPointForEveryRow) {
  const std::string svg = force_curve(
      "time [s],tip.x [m],ball.travel [m],ball.against "
      "[N]\n0,1,0,0\n0.5,1,0.001,2.5\n1,1,0.002,7\n",
      "ball");
  EXPECT_EQ(svg.compare(0, 4, "<svg"), 0);
  for (const char* text : {"travel [mm]", "force [N]", "Force on ball against its travel"})
    EXPECT_NE(svg.find(text), std::string::npos) << text;
}

TEST(ForceCurve, IsEmptyWithoutTheColumns) {
  EXPECT_EQ(force_curve("time [s],ball.x [m]\n0,1\n", "ball"), "");
  EXPECT_EQ(force_curve("", "ball"), "");
}

TEST(ForceCurve, RowsThatAreCutOffAreLeftOut) {
  EXPECT_NE(force_curve("time [s],b.travel [m],b.against [N]\n0,1,2\n1,2", "b"), "");
}

}  // namespace
}  // namespace sinew
