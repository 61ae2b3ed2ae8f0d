#include "sinew/sim/mover.h"

#include <gtest/gtest.h>

#include <numbers>

namespace sinew::sim {
namespace {

TEST(Mover, ARotationVectorIsTheOneNearestToTheOld) {
  const Mat3 quarter = Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitY()).toRotationMatrix();
  EXPECT_LT(
      (rotation_vector(quarter, Vec3::Zero()) - 0.5 * std::numbers::pi * Vec3::UnitY()).norm(),
      1e-12);
  const Vec3 turned_twice = 4.4 * std::numbers::pi * Vec3::UnitY();
  EXPECT_NEAR(rotation_vector(quarter, turned_twice).y(), 4.5 * std::numbers::pi, 1e-12);
  EXPECT_EQ(rotation_vector(Mat3::Identity(), Vec3::Zero()), Vec3::Zero());
  const Vec3 full = 2.1 * std::numbers::pi * Vec3::UnitZ();
  EXPECT_NEAR(rotation_vector(Mat3::Identity(), full).z(), 2.0 * std::numbers::pi, 1e-12);
}

TEST(Mover, APathIsLedFromWhereItIsToWhereItShallBe) {
  Path path;
  path.keys.push_back({0.0, Vec3::Zero()});
  path.keys.push_back({2.0, Vec3(2, 0, 0)});
  KeyFrame to;
  to.move = Vec3(1, 1, 0);
  lead_path(path, Vec3::Zero(), to, 0.1, 1.0, 1.5);
  EXPECT_LT((path.at(0.9, Vec3::Zero()) - Vec3(0.9, 0, 0)).norm(), 1e-12);  // as it was
  EXPECT_LT((path.at(1.0, Vec3::Zero()) - Vec3(1, 0, 0)).norm(), 1e-12);
  EXPECT_LT((path.at(1.25, Vec3::Zero()) - Vec3(1, 0.5, 0)).norm(), 1e-12);
  EXPECT_LT((path.at(9.0, Vec3::Zero()) - Vec3(1, 1, 0)).norm(), 1e-12);  // it stays there
}

}  // namespace
}  // namespace sinew::sim
