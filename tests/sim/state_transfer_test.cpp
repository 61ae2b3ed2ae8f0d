#include "sinew/sim/state_transfer.h"

#include <gtest/gtest.h>

#include "sinew/scene/build.h"
#include "sinew/scene/scene.h"

namespace sinew {
namespace {

TEST(StateTransfer, ABodyThatIsMadeSofterFliesAndTurnsAsBefore) {
  Model model = build_model(parse_scene(R"(
gravity = [0, 0, 0]
[body.box]
shape = "box"
cells = [3, 3, 3]
size = [0.1, 0.1, 0.1]
young = 2e4
velocity = [1, 2, 3]
spin = [0, 0, 5]
[pin.top]
select = { nearest = [0, 0, 0] }
)",
                                        "flying.toml", "."));
  model.inverse_mass.assign(model.mass.size(), 1.0);  // no pin
  Model softer = model;
  for (double& modulus : softer.tet_modulus) modulus *= 1e-4;
  State state = initial_state(model);
  for (const auto& pin : model.pins) {
    for (const Index n : pin.nodes) state.half_velocity[uz(n)] = model.start_velocity[uz(n)];
  }
  const std::vector<Vec3> before = state.half_velocity;
  damp_softened_bodies(model, softer, state);
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_LT((state.half_velocity[i] - before[i]).norm(), 1e-9);
  }
  state.half_velocity[3] += Vec3(1, 0, 0);
  const Vec3 fast = state.half_velocity[3];
  damp_softened_bodies(model, softer, state);
  EXPECT_GT((state.half_velocity[3] - fast).norm(), 0.5);
  const std::vector<Vec3> unchanged = state.half_velocity;
  damp_softened_bodies(softer, model, state);  // stiffer: nothing
  EXPECT_EQ(state.half_velocity, unchanged);
}

// Obstacles that are meshes have nodes of their own, the last ones.
TEST(StateTransfer, ObstaclesComeAndGoAndTheOthersKeepTheirPlaces) {
  constexpr const char* box = R"(
[body.box]
shape = "box"
cells = [1, 1, 1]
size = [0.1, 0.1, 0.1]
)";
  const auto with = [&](const std::string& obstacles) {
    return build_model(parse_scene(box + obstacles, "scene.toml", "."));
  };
  const std::string ball = "[obstacle.ball]\ncenter = [0, 1, 0]\nradius = 0.1\n";
  const std::string table = "[obstacle.table]\nshape = \"plane\"\ncenter = [0, -1, 0]\n";
  const Model before = with(ball + table);
  State old = initial_state(before);
  old.time = 0.5;
  old.step = 7;
  old.position[3] += Vec3(0.01, 0, 0);
  old.energy.work_in = 2.0;
  old.reactions.contacts.resize(1);
  old.obstacle_force = {Vec3(1, 0, 0), Vec3(0, 2, 0)};

  const Model after = with(table);
  const State s = transfer_state(before, old, after, initial_controls(after), "");
  EXPECT_EQ(s.position[3], old.position[3]);
  EXPECT_EQ(s.time, 0.5);
  EXPECT_EQ(s.step, 7);
  EXPECT_EQ(s.energy.work_in, 2.0);
  EXPECT_TRUE(s.reactions.contacts.empty());
  EXPECT_EQ(s.obstacle_force, (std::vector<Vec3>{Vec3(0, 2, 0)}));
  const State replaced = transfer_state(before, old, before, initial_controls(before), "table");
  EXPECT_EQ(replaced.obstacle_force, (std::vector<Vec3>{Vec3(1, 0, 0), Vec3::Zero()}));
}

}  // namespace
}  // namespace sinew
