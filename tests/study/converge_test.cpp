#include "sinew/study/converge.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sinew::study {
namespace {

std::vector<Vec3> sequence(double exact, double error, double order, int levels) {
  std::vector<Vec3> u;
  for (int l = 0; l < levels; ++l) u.emplace_back(0.0, exact + error * std::exp2(-order * l), 0.0);
  return u;
}

TEST(Trend, RichardsonIsExactForAPureOrder) {
  for (const double order : {1.0, 1.5, 2.0}) {
    const Trend t = trend_of("tip", sequence(-0.2, 0.03, order, 3));
    EXPECT_NEAR(t.order, order, 1e-9);
    EXPECT_NEAR(t.extrapolated.y(), -0.2, 1e-12);
    EXPECT_TRUE(t.converges);
    EXPECT_GT(t.error, std::abs(t.displacement.back().y() + 0.2));
  }
}

TEST(Trend, WhatDoesNotShrinkIsSaid) {
  EXPECT_FALSE(trend_of("tip", {Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(3, 0, 0)}).converges);
  EXPECT_FALSE(trend_of("tip", {Vec3(1, 0, 0), Vec3(1.1, 0, 0), Vec3(2, 0, 0)}).converges);
}

TEST(Trend, WhatDoesNotChangeHasNoOrder) {
  const Trend t = trend_of("tip", {Vec3(1, 0, 0), Vec3(1, 0, 0), Vec3(1, 0, 0)});
  EXPECT_TRUE(std::isnan(t.order));
  EXPECT_TRUE(t.converges);
  EXPECT_EQ(t.error, 0.0);
}

}  // namespace
}  // namespace sinew::study
