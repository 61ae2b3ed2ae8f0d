#include "sinew/report/json.h"

#include <gtest/gtest.h>

#include <limits>

namespace sinew::report {
namespace {

TEST(Json, NumbersThatJsonDoesNotHaveAreNull) {
  EXPECT_EQ(finite_or_null(1.5).dump(), "1.5");
  EXPECT_EQ(finite_or_null(std::numeric_limits<double>::quiet_NaN()).dump(), "null");
  EXPECT_EQ(finite_or_null(std::numeric_limits<double>::infinity()).dump(), "null");
}

TEST(Json, VectorsAndStatistics) {
  EXPECT_EQ(to_json(Vec3(1, -2, 0.5)).dump(), "[1.0,-2.0,0.5]");
  EXPECT_EQ(to_json(Statistics{1, 2, 3}).dump(), R"({"min":1.0,"mean":2.0,"max":3.0})");
}

}  // namespace
}  // namespace sinew::report
