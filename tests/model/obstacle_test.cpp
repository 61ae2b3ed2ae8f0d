#include "sinew/model/obstacle.h"

#include <gtest/gtest.h>

namespace sinew {
namespace {

TEST(Obstacle, OnlyASphereHasASoftRadiusAndOnlyAMeshHasNodes) {
  Obstacle o;
  o.shape = shapes::Sphere{0.3};
  EXPECT_EQ(o.soft_radius(), 0.3);
  EXPECT_EQ(o.mesh(), nullptr);
  EXPECT_EQ(o.nodes().size(), 0);
  o.shape = shapes::Capsule{0.3, 1.0};
  EXPECT_EQ(o.soft_radius(), 0.0);
  o.shape = shapes::Mesh{{4, 9}, {}};
  EXPECT_EQ(o.nodes().size(), 5);
}

TEST(Obstacle, TheGroundIsAHardPlaneThatNoTableLists) {
  for (const Vec3& normal : {Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(Vec3(1, 2, -2) / 3.0)}) {
    const Obstacle ground = make_ground(Vec3(0, -1, 0), normal, 0.2, 0.7);
    EXPECT_TRUE(ground.hard());
    EXPECT_FALSE(ground.listed);
    EXPECT_TRUE(std::holds_alternative<shapes::Plane>(ground.shape));
    EXPECT_LT((ground.rotation.col(1) - normal).norm(), 1e-15);
    EXPECT_EQ(ground.center, Vec3(0, -1, 0));
    EXPECT_EQ(ground.restitution, 0.2);
    EXPECT_EQ(ground.friction, 0.7);
  }
  // To the last bit: the gap of a node above y = h is y - h.
  EXPECT_EQ(make_ground(Vec3::Zero(), Vec3::UnitY(), 0.0, 0.0).rotation, Mat3::Identity());
}

}  // namespace
}  // namespace sinew
