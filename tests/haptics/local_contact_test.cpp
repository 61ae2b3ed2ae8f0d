#include "sinew/haptics/local_contact.h"

#include <gtest/gtest.h>

namespace sinew {
namespace {

LocalContact plane() {
  LocalContact c;
  c.force = Vec3(0.0, 0.0, 2.0);
  c.gap = 0.0;
  c.stiffness = 1000.0;
  return c;
}

TEST(LocalContact, SpringAndPlaneAreInBalance) {
  const LocalContact c = plane();
  const Vec3 hand(0.0002, 0.0, -0.003);
  const ToolForce tool = balance(c, hand, 500.0, 10.0);
  EXPECT_NEAR((500.0 * (hand - tool.at) + tool.force).norm(), 0.0, 1e-12);
  EXPECT_NEAR(tool.force.z(), 2.0 - 1000.0 * tool.at.z(), 1e-12);
  EXPECT_NEAR(tool.force.x(), -1000.0 * tool.at.x(), 1e-12);
}

TEST(LocalContact, DoesNotPull) {
  const ToolForce tool = balance(plane(), Vec3(0.0, 0.0, 0.01), 500.0, 0.3);
  EXPECT_EQ(tool.force, Vec3(Vec3::Zero()));
  EXPECT_EQ(tool.at, Vec3(0.0, 0.0, 0.01));
}

TEST(LocalContact, StartsAtTheGap) {
  LocalContact c = plane();
  c.force = Vec3::Zero();
  c.gap = 0.002;
  EXPECT_EQ(balance(c, Vec3(0.0, 0.0, -0.0019), 500.0, 0.3).force.norm(), 0.0);
  const ToolForce tool = balance(c, Vec3(0.0, 0.0, -0.005), 500.0, 0.3);
  EXPECT_NEAR(tool.force.z(), 500.0 * 1000.0 / 1500.0 * 0.003, 1e-12);
}

TEST(LocalContact, FrictionIsOfCoulomb) {
  const ToolForce tool = balance(plane(), Vec3(0.05, 0.0, -0.003), 500.0, 0.3);
  EXPECT_NEAR(tool.force.x(), -0.3 * tool.force.z(), 1e-12);
  EXPECT_NEAR((500.0 * (Vec3(0.05, 0.0, -0.003) - tool.at) + tool.force).norm(), 0.0, 1e-12);
}

}  // namespace
}  // namespace sinew
