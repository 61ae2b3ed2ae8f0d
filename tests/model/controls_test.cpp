#include "sinew/model/controls.h"

#include <gtest/gtest.h>

#include <type_traits>

namespace sinew {
namespace {

static_assert(!std::is_default_constructible_v<Controls> && !std::is_aggregate_v<Controls>,
              "Controls without a Model would have no paths");

Path turning(const Vec3& pivot) {
  return {{{0.0}, {2.0, Vec3(0, 4, 0), Vec3(0, 0, M_PI)}}, pivot, false};
}

Model with_an_obstacle() {
  Model m;
  Obstacle o;
  o.center = Vec3(1, 0, 0);
  o.rotation = Eigen::AngleAxisd(0.5 * M_PI, Vec3::UnitZ()).toRotationMatrix();
  o.path = turning(o.center);
  m.obstacles = {Obstacle{}, o};
  m.pins = {{"still", {0}, {}}, {"turning", {1}, turning(Vec3::Zero())}};
  m.start_gravity = Vec3(1, 2, 3);
  return m;
}

TEST(Controls, StartAsTheModelSays) {
  const Model m = with_an_obstacle();
  const Controls controls = initial_controls(m);
  EXPECT_EQ(controls.gravity, Vec3(1, 2, 3));
  ASSERT_EQ(controls.pin_paths.size(), 2U);
  EXPECT_TRUE(controls.pin_paths[0].keys.empty());
  EXPECT_EQ(controls.pin_paths[1].at(1.5, Vec3(3, 1, 4)), m.pins[1].path.at(1.5, Vec3(3, 1, 4)));
  ASSERT_EQ(controls.obstacle_paths.size(), 2U);
  EXPECT_EQ(controls.obstacle_paths[1].pivot, Vec3(1, 0, 0));
  EXPECT_TRUE(controls.tools.empty());
  EXPECT_TRUE(controls.grabs.empty());
}

TEST(Controls, AnObstaclesPathMovesAndTurnsItsPose) {
  const Model m = with_an_obstacle();
  Controls controls = initial_controls(m);
  const Pose pose = obstacle_pose(m, controls, 1, 1.0);
  EXPECT_LT((pose.center - Vec3(1, 2, 0)).norm(), 1e-15);
  EXPECT_LT((pose.turn * Vec3::UnitX() + Vec3::UnitX()).norm(), 1e-15);  // by 90 and 90 degrees
  EXPECT_LT((pose.own(pose.at(Vec3(3, 5, 7))) - Vec3(3, 5, 7)).norm(), 1e-14);
  EXPECT_EQ(obstacle_pose(m, controls, 0, 1.0).center, Vec3::Zero());

  // What counts is the path of the controls, not the one that they started with.
  controls.obstacle_paths[1] = {};
  EXPECT_EQ(obstacle_pose(m, controls, 1, 1.0).center, Vec3(1, 0, 0));
}

TEST(Controls, PathsOfPinsObstaclesAndToolsCount) {
  const Model m = with_an_obstacle();
  const auto moves = [](const Path& path) { return !path.keys.empty(); };
  Controls controls = initial_controls(m);
  EXPECT_TRUE(any_path(controls, moves));
  controls.pin_paths[1] = {};
  EXPECT_TRUE(any_path(controls, moves));
  controls.obstacle_paths[1] = {};
  EXPECT_FALSE(any_path(controls, moves));
  controls.tools.push_back({Vec3::Zero(), 1.0, 1.0, turning(Vec3::Zero())});
  EXPECT_TRUE(any_path(controls, moves));
}

}  // namespace
}  // namespace sinew
