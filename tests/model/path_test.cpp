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

TEST(Path, DeformsAboutThePivotBeforeItTurns) {
  Path p;
  p.pivot = Vec3(1, 0, 0);
  KeyFrame key{1.0, Vec3(0, 0, 7), Vec3(0, 0, std::numbers::pi / 2)};
  key.deform << 2, 1, 0,  //
      0, 3, 0,            //
      0, 0, 1;
  p.keys = {key};
  // Arm (1, 1, 0) -> (3, 3, 0) -> (-3, 3, 0).
  EXPECT_LT((p.at(1.0, Vec3(2, 1, 0)) - Vec3(-2, 3, 7)).norm(), 1e-15);
  // Halfway, without the turn: F = [1.5 0.5 0; 0 2 0; 0 0 1].
  p.keys[0].turn = Vec3::Zero();
  EXPECT_LT((p.at(0.5, Vec3(2, 1, 0)) - Vec3(3, 2, 3.5)).norm(), 1e-15);
  EXPECT_EQ(p.at(5.0, Vec3(2, 1, 0)), Vec3(4, 3, 7));
}

TEST(Path, WithoutDeformHasTheBitsOfAMove) {
  Path p;
  p.pivot = Vec3(0.1, 0.2, 0.3);
  p.keys = {{0.7, Vec3(0.3, 0.1, 0), Vec3::Zero()}, {1.9, Vec3(1.3, 0.7, 0), Vec3::Zero()}};
  const Vec3 X(0.123456789, 0.987654321, 0.555);
  for (double t = 0.0; t < 2.0; t += 0.013) {
    const double s = t < 0.7 ? t / 0.7 : (t - 0.7) / (1.9 - 0.7);
    const Vec3 from = t < 0.7 ? Vec3(0, 0, 0) : p.keys[0].move;
    const Vec3 to = t < 0.7 ? p.keys[0].move : p.keys[1].move;
    const Vec3 move = t < 1.9 ? Vec3((1 - s) * from + s * to) : p.keys[1].move;
    EXPECT_EQ(p.at(t, X), Vec3(X + move)) << t;
  }
}

}  // namespace
}  // namespace sinew
