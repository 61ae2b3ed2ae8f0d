#include "sinew/model/path.h"

#include <gtest/gtest.h>

#include <numbers>

namespace sinew {
namespace {

TEST(Path, WithoutKeysStandsStill) {
  EXPECT_EQ(Path{}.at(7.0, Vec3(1, 2, 3)), Vec3(1, 2, 3));
}

TEST(Path, RunsLinearlyBetweenKeysFromRestAtZero) {
  Path p;
  p.keys = {{2.0, Vec3(4, 0, 0), Vec3::Zero()}, {3.0, Vec3(4, 1, 0), Vec3::Zero()}};
  EXPECT_EQ(p.at(0.0, Vec3::Zero()), Vec3::Zero());
  EXPECT_EQ(p.at(1.0, Vec3::Zero()), Vec3(2, 0, 0));
  EXPECT_EQ(p.at(2.5, Vec3::Zero()), Vec3(4, 0.5, 0));
  EXPECT_EQ(p.at(9.0, Vec3::Zero()), Vec3(4, 1, 0));
}

TEST(Path, SmoothStartsAndEndsAtRestAndMeetsInTheMiddle) {
  Path p;
  p.smooth = true;
  p.keys = {{1.0, Vec3(1, 0, 0), Vec3::Zero()}};
  EXPECT_DOUBLE_EQ(p.at(0.5, Vec3::Zero()).x(), 0.5);
  EXPECT_LT(p.at(0.01, Vec3::Zero()).x(), 4e-4);
  EXPECT_GT(p.at(0.99, Vec3::Zero()).x(), 1 - 4e-4);
}

TEST(Path, TurnsAboutThePivot) {
  Path p;
  p.pivot = Vec3(1, 0, 0);
  p.keys = {{1.0, Vec3::Zero(), Vec3(0, 0, std::numbers::pi)}};
  EXPECT_LT((p.at(1.0, Vec3(2, 0, 5)) - Vec3(0, 0, 5)).norm(), 1e-15);
  EXPECT_LT((p.at(0.5, Vec3(2, 0, 5)) - Vec3(1, 1, 5)).norm(), 1e-15);
}

TEST(Path, AKeyAtZeroIsWhereItStarts) {
  Path p;
  p.keys = {{0.0, Vec3(1, 0, 0), Vec3::Zero()}, {1.0, Vec3(3, 0, 0), Vec3::Zero()}};
  EXPECT_EQ(p.at(0.0, Vec3::Zero()), Vec3(1, 0, 0));
  EXPECT_EQ(p.at(0.5, Vec3::Zero()), Vec3(2, 0, 0));
}

}  // namespace
}  // namespace sinew
