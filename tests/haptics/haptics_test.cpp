#include <gtest/gtest.h>
#include <sinew/error.h>
#include <sinew/sinew.h>

#include <chrono>
#include <cmath>
#include <thread>

namespace sinew {
namespace {

SceneBuilder slab(int cells, const std::string& law = {}) {
  SceneBuilder scene;
  scene.add_body({.name = "slab",
                  .shape = "box",
                  .cells = {{cells, cells / 2, cells}},
                  .size = {{0.08, 0.04, 0.08}},
                  .material = {.law = law, .density = 1060.0, .young = 5e3, .poisson = 0.45}});
  scene.add_pin({.name = "table", .select = {.side = "-y"}});
  scene.add_obstacle({.name = "tool",
                      .shape = "sphere",
                      .center = Point{0.0, 0.04, 0.0},
                      .radius = 0.015,
                      .friction = 0.3});
  return scene;
}

HandDescription pressing_hand() {
  HandDescription hand;
  hand.start = {0.0, 0.04, 0.0};
  hand.aim = [](double t) { return Point{0.0, 0.04 - std::min(0.02, 0.05 * t), 0.0}; };
  return hand;
}

// At rest the hand feels what the whole simulation gives at the tool's place, and the spring of the
// hand is in balance with it.
TEST(Haptics, TheForceAtRestIsThatOfTheSimulation) {
  Simulation simulation{slab(8)};
  SimulatedHand hand(pressing_hand());
  Haptics haptics(simulation, simulation.obstacle("tool"), hand);
  for (int k = 0; k < 250; ++k) {
    for (int t = 0; t < 10; ++t) haptics.tick();
    haptics.advance(0.01);
  }
  const double felt = haptics.force().force[1];
  const double simulated = simulation.wrench(simulation.obstacle("tool")).force[1];
  EXPECT_GT(felt, 0.1);
  EXPECT_NEAR(felt, simulated, 0.03 * felt);
  EXPECT_LT(std::abs(hand.velocity()[1]), 1e-3);
  EXPECT_GT(haptics.statistics().energy, 0.0);
}

TEST(Haptics, FeelEveryLaw) {
  for (const char* law : {"calibrated", "lloyd", "vangelder"}) {
    Simulation simulation{slab(4, law)};
    HandDescription description = pressing_hand();
    description.start = {0.0, 0.0355, 0.0};
    description.aim = [](double) { return Point{0.0, 0.0, 0.0}; };
    SimulatedHand hand(description);
    Haptics haptics(simulation, simulation.obstacle("tool"), hand);
    for (int k = 0; k < 8; ++k) {
      for (int t = 0; t < 10; ++t) haptics.tick();
      haptics.advance(0.01);
    }
    EXPECT_GT(haptics.force().force[1], 0.0) << law;
  }
}

TEST(Haptics, TheLoopRunsBesideTheSimulation) {
  Simulation simulation{slab(6)};
  SimulatedHand hand(pressing_hand());
  Haptics haptics(simulation, simulation.obstacle("tool"), hand);
  haptics.run(0.3);
  haptics.stop();
  const HapticsStatistics s = haptics.statistics();
  EXPECT_GT(s.ticks, 20);
  EXPECT_GT(s.exchanges, 2);
  EXPECT_FALSE(haptics.reason().empty());
  EXPECT_NO_THROW(haptics.tick());
}

TEST(Haptics, RefusesWhatCannotBe) {
  Simulation simulation{slab(6)};
  SimulatedHand hand(pressing_hand());
  EXPECT_THROW(Haptics(simulation, simulation.obstacle("tool"), hand, {.coupling = 0.0}), Error);
  EXPECT_THROW(Haptics(simulation, simulation.obstacle("tool"), hand, {.scale = -1.0}), Error);
  EXPECT_THROW(Haptics(simulation, ObstacleHandle{}, hand), Error);
  EXPECT_THROW(SimulatedHand(HandDescription{}), Error);
  EXPECT_THROW(RecordedPath({}), Error);
}

}  // namespace
}  // namespace sinew
