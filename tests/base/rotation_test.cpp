#include "sinew/base/rotation.h"

#include <gtest/gtest.h>

namespace sinew {
namespace {

TEST(Rotation, TurnsOneDirectionIntoTheOther) {
  const Vec3 directions[] = {{0, 1, 0},  {0, 0, 1},        {1, 2, -3},
                             {0, -1, 0}, {-1, -2, 3.0001}, {1e-9, -1, 0}};
  for (const Vec3& a : directions) {
    for (const Vec3& b : directions) {
      const Eigen::Quaterniond q = rotation_between(a, 2.0 * b);
      EXPECT_NEAR(q.norm(), 1.0, 1e-12);
      EXPECT_LT((q * a.normalized() - b.normalized()).norm(), 1e-12);
      // The shortest: no rotation about the directions themselves.
      EXPECT_NEAR(q.vec().dot(a.normalized()), 0.0, 1e-12);
    }
  }
}

TEST(Rotation, OppositeDirectionsAreHalfATurnApart) {
  for (const Vec3& a : {Vec3(0, 1, 0), Vec3(1, -2, 3)}) {
    const Eigen::Quaterniond q = rotation_between(a, -a);
    EXPECT_EQ(q.w(), 0.0);
    EXPECT_LT((q * a + a).norm(), 1e-12);
  }
}

TEST(Rotation, TheNearestRotationUndoesAStretch) {
  const Mat3 turn = Eigen::AngleAxisd(2.0, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  const Mat3 stretch = Vec3(0.1, 3.0, 1.5).asDiagonal();
  EXPECT_LT((nearest_rotation(turn * stretch) - turn).norm(), 1e-12);
  EXPECT_NEAR(nearest_rotation(-turn * stretch).determinant(), 1.0, 1e-12);
}

}  // namespace
}  // namespace sinew
