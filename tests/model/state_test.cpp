#include "sinew/model/state.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sinew {
namespace {

// Two nodes, of which a pin moves the second.
Model two_nodes() {
  Model model;
  model.rest_position = {Vec3(1, 2, 3), Vec3(4, 5, 6)};
  model.start_velocity = {Vec3(0, 0, 7), Vec3::Zero()};
  Body body;
  body.nodes = {0, 2};
  model.bodies = {body};
  Pin pin;
  pin.nodes = {1};
  pin.path.keys = {{0.0, Vec3(1, 0, 0)}, {1.0, Vec3(2, 0, 0)}};
  model.pins = {pin};
  return model;
}

TEST(State, StartsWhereTheModelSays) {
  Model model = two_nodes();
  State state = initial_state(model);
  EXPECT_EQ(state.position[0], Vec3(1, 2, 3));
  EXPECT_EQ(state.position[1], Vec3(5, 5, 6));
  EXPECT_EQ(state.half_velocity[0], Vec3(0, 0, 7));
  EXPECT_EQ(state.time, 0.0);
  EXPECT_EQ(state.step, 0);
  EXPECT_TRUE(state.reactions.contacts.empty());
  model.start_position = {Vec3(9, 9, 9), Vec3(4, 5, 6)};
  EXPECT_EQ(initial_state(model).position[0], Vec3(9, 9, 9));
}

TEST(State, TheHashSeesEveryBitOfTheMotion) {
  const State state = initial_state(two_nodes());
  State other = state;
  EXPECT_EQ(other.hash(), state.hash());
  other.position[0].x() = std::nextafter(other.position[0].x(), 2.0);
  EXPECT_NE(other.hash(), state.hash());
  other = state;
  other.half_velocity[1].y() = 1e-300;
  EXPECT_NE(other.hash(), state.hash());
  other = state;
  ++other.step;
  EXPECT_NE(other.hash(), state.hash());
}

TEST(ContactForce, CountsTheNodesThatItUses) {
  ContactForce force;
  EXPECT_EQ(force.count(), 0U);
  force.node = {3, 5, -1, -1};
  EXPECT_EQ(force.count(), 2U);
  force.node = {3, 5, 8, 1};
  EXPECT_EQ(force.count(), 4U);
}

}  // namespace
}  // namespace sinew
