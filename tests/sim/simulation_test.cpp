#include <sinew/sinew.h>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/support/effort.h"

namespace sinew {
namespace {

// A box of soft tissue, 10 cm wide, that stands on a pin.
SceneBuilder standing_box(const std::string& stepper = {}) {
  SceneBuilder scene;
  scene.set_stepping({.stepper = stepper});
  scene.add_body({.name = "box",
                  .shape = "box",
                  .cells = {{3, 3, 3}},
                  .size = {{0.1, 0.1, 0.1}},
                  .position = {{0.05, 0.05, 0.05}},
                  .material = {.young = 5e3}});
  scene.add_pin({.name = "floor", .select = {.side = "-y"}});
  scene.add_probe({.name = "top", .select = {.side = "+y"}});
  return scene;
}

const ObstacleDescription ball = {
    .name = "ball", .center = {{0.05, 0.125, 0.05}}, .radius = 0.02, .friction = 0.3};

double total_mass(const Simulation& s) {
  double mass = 0.0;
  for (const double m : s.masses()) mass += m;
  return mass;
}

TEST(Simulation, ShowsItsArraysWithoutACopy) {
  Simulation s(standing_box());
  EXPECT_EQ(s.positions().size(), 64U);
  EXPECT_EQ(s.velocities().size(), 64U);
  EXPECT_EQ(s.forces().size(), 64U);
  EXPECT_EQ(s.rest_positions().data(), s.rest_positions().data());
  ASSERT_EQ(s.bodies().size(), 1U);
  EXPECT_EQ(s.bodies()[0].name, "box");
  EXPECT_EQ(s.bodies()[0].nodes.count, 64);
  EXPECT_EQ(static_cast<std::size_t>(s.bodies()[0].tets.count), s.tets().size());
  EXPECT_NEAR(s.bodies()[0].rest_volume, 1e-3, 1e-12);
  EXPECT_NEAR(total_mass(s), 1.06, 1e-9);
  EXPECT_EQ(s.surface().size(), 6U * 9U * 2U);
  const Index corner = s.nearest_node({1.0, 1.0, 1.0});
  for (const double x : s.positions()[static_cast<std::size_t>(corner)]) EXPECT_NEAR(x, 0.1, 1e-12);
}

TEST(Simulation, OneThatFallsFeelsGravityAlone) {
  SceneBuilder scene;
  scene.add_body({.name = "box", .shape = "box", .cells = {{2, 2, 2}}, .size = {{0.1, 0.1, 0.1}}});
  Simulation s(scene);
  for (std::size_t i = 0; i < s.forces().size(); ++i)
    EXPECT_NEAR(s.forces()[i][1], -9.81 * s.masses()[i], 1e-9);
  s.set_gravity({0.0, 1.0, 0.0});
  for (std::size_t i = 0; i < s.forces().size(); ++i)
    EXPECT_NEAR(s.forces()[i][1], s.masses()[i], 1e-9);
  s.advance(0.1);
  EXPECT_NEAR(s.time(), 0.1, 1e-15);
  for (std::size_t i = 0; i < s.positions().size(); ++i)
    EXPECT_NEAR(s.positions()[i][1] - s.rest_positions()[i][1], 0.5 * 0.01, 1e-4);
}

TEST(Simulation, APinBearsTheWeight) {
  Simulation s(standing_box("static"));
  s.step();
  const Wrench w = s.wrench(s.pin("floor"), {0.05, 0.0, 0.05});
  const double weight = 9.81 * total_mass(s);
  EXPECT_NEAR(w.force[1], -weight, 1e-4 * weight);
  EXPECT_NEAR(w.force[0], 0.0, 1e-4 * weight);
  EXPECT_NEAR(w.torque[0], 0.0, 0.01 * weight);  // the mesh is not quite symmetric
  // About a point 1 m to the side along x, the lever turns about z.
  EXPECT_NEAR(s.wrench(s.pin("floor"), {1.05, 0.0, 0.05}).torque[2], weight, 0.01 * weight);
}

TEST(Simulation, AdvanceArrivesAtTheTimeThatIsAskedFor) {
  Simulation s(standing_box());
  double time = 0.0;
  for (const double seconds : {1e-3, 0.05, 1e-4, 0.0, 1.0 / 30.0, 7e-3}) {
    EXPECT_TRUE(s.advance(seconds));
    time += seconds;
    EXPECT_NEAR(s.time(), time, 1e-12);
  }
}

TEST(Simulation, WithAGivenStepAdvanceTakesTheNearestAndCarriesTheRest) {
  SceneBuilder scene = standing_box();
  scene.set_stepping({.dt = 2e-4});
  Simulation s(scene);
  for (int i = 0; i < 10; ++i) s.advance(0.5e-4);  // 2.5 steps in all
  EXPECT_TRUE(s.steps() == 2 || s.steps() == 3) << s.steps();
  EXPECT_NEAR(s.time(), 2e-4 * static_cast<double>(s.steps()), 1e-15);
  for (int i = 0; i < 10; ++i) s.advance(1e-3);
  EXPECT_TRUE(s.steps() == 52 || s.steps() == 53) << s.steps();
}

TEST(Simulation, StepsOfTheHostsOwnLength) {
  for (const char* stepper : {"verlet", "implicit"}) {
    Simulation s(standing_box(stepper));
    EXPECT_EQ(s.stepper(), stepper);
    const double h = 1e-4;
    for (int i = 0; i < 5; ++i) s.step(h);
    EXPECT_NEAR(s.time(), 5e-4, 1e-15);
    EXPECT_EQ(s.last_step(), h);
    EXPECT_EQ(s.steps(), 5);
    s.step();
    s.advance(0.01);
    EXPECT_GT(s.time(), 0.0105);
  }
}

// What a host steps in pieces ends where the scene's frames end: with the same bits.
TEST(Simulation, FramesInPiecesOfStepsAreTheSameBits) {
  for (const char* stepper : {"verlet", "implicit"}) {
    Simulation whole(standing_box(stepper));
    whole.advance(0.1);
    Simulation frames(standing_box(stepper));
    for (int i = 0; i < 3; ++i) frames.advance(1.0 / 30.0);
    EXPECT_EQ(frames.hash(), whole.hash());
    Simulation steps(standing_box(stepper));
    while (steps.time() < 0.1 - 1e-9) steps.step();
    EXPECT_EQ(steps.hash(), whole.hash());
  }
}

TEST(Simulation, AnObstacleIsMovedOverACallAndStays) {
  SceneBuilder scene = standing_box();
  scene.add_obstacle(ball);
  Simulation s(scene);
  const ObstacleHandle tool = s.obstacle("ball");
  s.advance(0.01);
  s.move(tool, {.center = {0.05, 0.115, 0.05}, .rotation = {0.0, 0.0, 2.0, 0.0}});
  EXPECT_NEAR(s.pose(tool).center[1], 0.125, 1e-15);  // not yet
  s.advance(0.01);
  EXPECT_NEAR(s.pose(tool).center[1], 0.115, 1e-12);
  EXPECT_NEAR(std::abs(s.pose(tool).rotation[2]), 1.0, 1e-12);
  s.advance(0.01);
  EXPECT_NEAR(s.pose(tool).center[1], 0.115, 1e-12);
  s.place(tool, {.center = {0.05, 0.3, 0.05}});
  EXPECT_NEAR(s.pose(tool).center[1], 0.3, 1e-12);
  EXPECT_EQ(s.depth(tool), 0.0);
  EXPECT_TRUE(s.contacts(tool).empty());
}

TEST(Simulation, APressedBallFeelsForceAndTorque) {
  for (const bool soft : {false, true}) {
    SceneBuilder scene = standing_box("implicit");
    ObstacleDescription o = ball;
    if (soft) {
      o.soft = true;  // pushes nodes alone: one that fits between them would touch nothing
      o.radius = 0.05;
      o.center = {{0.05, 0.145, 0.05}};
      o.friction.reset();
    }
    scene.add_obstacle(o);
    Simulation s(scene);
    const ObstacleHandle tool = s.obstacle("ball");
    for (int i = 1; i <= 20; ++i) {
      s.move(tool, {.center = {0.05, (soft ? 0.145 : 0.125) - 1e-3 * i, 0.05}});
      s.advance(5e-3);
    }
    const Wrench w = s.wrench(tool, {0.05, 0.0, 0.05});
    EXPECT_GT(w.force[1], 0.01) << soft;
    EXPECT_GT(w.force[1], 3.0 * std::abs(w.force[0])) << soft;
    // The lever of 1 m along x turns the force about z.
    const Wrench aside = s.wrench(tool, {-0.95, 0.0, 0.05});
    EXPECT_NEAR(aside.torque[2] - w.torque[2], w.force[1], 1e-9) << soft;
    ASSERT_FALSE(s.contacts(tool).empty()) << soft;
    for (const ContactPoint& c : s.contacts(tool)) {
      EXPECT_LT(c.normal[1], 0.0);
      EXPECT_LE(c.depth, s.depth(tool));
    }
    if (soft) {
      EXPECT_GT(s.depth(tool), 0.0);
    }
  }
}

// The force on a hard plane under a body that has come to rest is the body's weight.
TEST(Simulation, APlaneBearsTheWeight) {
  SceneBuilder scene;
  scene.set_stepping({.stepper = "implicit", .scheme = "backward-euler"});
  scene.add_body({.name = "box",
                  .shape = "box",
                  .cells = {{2, 2, 2}},
                  .size = {{0.1, 0.1, 0.1}},
                  .position = {{0.05, 0.05, 0.05}},
                  .material = {.young = 2e4}});
  scene.add_obstacle({.name = "table", .shape = "plane", .center = {{0.0, 0.0, 0.0}}});
  Simulation s(scene);
  s.advance(2.0);
  const double weight = 9.81 * total_mass(s);
  const Wrench w = s.wrench(s.obstacle("table"), {0.05, 0.0, 0.05});
  EXPECT_NEAR(w.force[1], -weight, 0.02 * weight);
  EXPECT_NEAR(w.torque[2], 0.0, 0.01 * weight);
}

// Where a body rests, what bears it and its weight cancel.
TEST(Simulation, ForcesOfContactsAndOfTheGroundAreAmongThoseOfTheNodes) {
  for (const bool ground : {false, true})
    for (const char* stepper : {"verlet", "implicit"}) {
      SceneBuilder scene;
      scene.set_stepping({.stepper = stepper});
      scene.add_body({.name = "box",
                      .shape = "box",
                      .cells = {{2, 2, 2}},
                      .size = {{0.1, 0.1, 0.1}},
                      .position = {{0.05, 0.05, 0.05}},
                      .material = {.young = 2e4, .drag = 10.0}});
      if (ground) {
        scene.set_ground({.point = {{0.0, 0.0, 0.0}}});
      } else {
        scene.add_obstacle({.name = "table", .shape = "plane", .center = {{0.0, 0.0, 0.0}}});
      }
      Simulation s(scene);
      s.advance(2.0);
      const double weight = 9.81 * total_mass(s);
      double sum = 0.0, down = 0.0;
      for (const Point& f : s.forces()) {
        sum += f[1];
        down = std::min(down, f[1]);
      }
      EXPECT_NEAR(sum, 0.0, 0.03 * weight) << stepper << ground;
      EXPECT_GT(down, -0.1 * weight) << stepper << ground;
    }
}

TEST(Simulation, APinIsMoved) {
  Simulation s(standing_box());
  const PinHandle floor = s.pin("floor");
  for (int i = 1; i <= 10; ++i) {
    s.move(floor, {.move = {0.0, 1e-3 * i, 0.0}, .turn = {0.0, 1e-2 * i, 0.0}});
    s.advance(5e-3);
  }
  EXPECT_NEAR(s.motion(floor).move[1], 0.01, 1e-12);
  EXPECT_NEAR(s.motion(floor).turn[1], 0.1, 1e-12);
  for (std::size_t i = 0; i < s.positions().size(); ++i)
    if (s.rest_positions()[i][1] == 0.0) {
      EXPECT_NEAR(s.positions()[i][1], 0.01, 1e-12);
    }
}

TEST(Simulation, AGrabPullsItsPatch) {
  Simulation s(standing_box("implicit"));
  const Index node = s.nearest_node({0.05, 0.1, 0.05});
  const GrabHandle grab = s.grab(node, 0.04);
  EXPECT_NEAR(s.force(grab)[1], 0.0, 1e-12);
  Point target = s.target(grab);
  const double start = target[1];
  target[1] += 0.02;
  s.move(grab, target);
  EXPECT_GT(s.force(grab)[1], 0.0);
  s.advance(0.5);
  EXPECT_GT(s.positions()[static_cast<std::size_t>(node)][1], start + 0.005);
  EXPECT_EQ(s.grabs().size(), 1U);
  s.release(grab);
  EXPECT_TRUE(s.grabs().empty());
  s.advance(0.1);
}

TEST(Simulation, ObstaclesComeAndGoInMidRun) {
  Simulation s(standing_box());
  s.advance(0.05);
  const std::string before = s.hash();
  const ObstacleHandle tool = s.add_obstacle(ball);
  EXPECT_EQ(s.hash(), before);  // nothing has moved
  s.move(tool, {.center = {0.05, 0.1, 0.05}});
  s.advance(0.05);
  EXPECT_GT(s.wrench(tool).force[1], 0.0);
  const Point where = s.pose(tool).center;
  const ObstacleHandle block =
      s.add_obstacle({.name = "block",
                      .shape = "mesh",
                      .arrays = {{.nodes = {{0, 1, 0}, {0.1, 1, 0}, {0, 1, 0.1}, {0, 1.1, 0}},
                                  .triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}}}});
  EXPECT_EQ(s.pose(tool).center, where);  // what a host has moved stays where it is
  s.move(block, {.center = {0.0, -0.2, 0.0}});
  s.advance(0.01);
  s.change(tool,
           {.shape = "capsule", .center = {{0.05, 0.2, 0.05}}, .radius = 0.01, .length = 0.02});
  EXPECT_NEAR(s.pose(tool).center[1], 0.2, 1e-15);
  s.advance(0.01);
  EXPECT_NEAR(s.pose(block).center[1], -0.2, 1e-12);
  s.remove(tool);
  EXPECT_EQ(s.obstacle_names(), std::vector<std::string>{"block"});
  s.advance(0.01);
  s.remove(block);
  s.advance(0.01);
  EXPECT_EQ(s.positions().size(), 64U);
}

TEST(Simulation, AMaterialIsChangedInMidRun) {
  Simulation s(standing_box("implicit"));
  s.advance(1.0);
  const double before = s.probes()[0].displacement[1];
  const std::string hash = s.hash();
  s.change(s.material("box"), {.young = 5e4});
  s.advance(1.0);
  EXPECT_GT(s.probes()[0].displacement[1], 0.5 * before);  // it sags less: both are negative
  EXPECT_NE(s.hash(), hash);
  s.change(s.material("box"), {.tissue = "liver"});
  s.advance(0.01);
}

TEST(Simulation, AStateThatIsRestoredGoesOnWithTheSameBits) {
  for (const char* stepper : {"verlet", "implicit"}) {
    SceneBuilder scene = standing_box(stepper);
    scene.add_obstacle(ball);
    const auto drive = [](Simulation& s, int from, int to) {
      for (int i = from; i < to; ++i) {
        s.move(s.obstacle("ball"), {.center = {0.05, 0.125 - 5e-4 * i, 0.05}});
        s.advance(2.7e-3);
        s.step();
      }
    };
    Simulation s(scene);
    drive(s, 0, 10);
    const GrabHandle grab = s.grab(s.nearest_node({0.1, 0.1, 0.1}), 0.04);
    s.move(grab, {0.12, 0.1, 0.1});
    s.set_gravity({1.0, -9.0, 0.0});
    s.step();
    const SavedState saved = s.save();
    const std::string at = s.hash();
    drive(s, 10, 20);
    const std::string end = s.hash();

    s.release(grab);
    s.set_gravity({0.0, 0.0, 0.0});
    s.restore(saved);
    EXPECT_EQ(s.hash(), at);
    s.force(grab);  // the grab holds again
    drive(s, 10, 20);
    EXPECT_EQ(s.hash(), end) << stepper;

    Simulation other(scene);
    other.restore(SavedState(saved.bytes()));
    EXPECT_EQ(other.grabs().size(), 1U);
    drive(other, 10, 20);
    EXPECT_EQ(other.hash(), end) << stepper;
  }
}

TEST(Simulation, EventsTellOfTheStepperAndOfTetsInsideOut) {
  SceneBuilder scene = standing_box("auto");
  Simulation s(scene);
  const std::vector<Event> events = s.take_events();
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].kind, EventKind::stepper_changed);
  EXPECT_NE(events[0].text.find(s.stepper()), std::string::npos);

  SceneBuilder inverted;
  inverted.add_body({.name = "box",
                     .shape = "box",
                     .cells = {{2, 2, 2}},
                     .size = {{0.1, 0.2, 0.2}},
                     .start = "inverted"});
  Simulation t(inverted);
  EXPECT_GT(t.inverted_tets(), 0);
  t.advance(0.05);
  bool told = false;
  for (const Event& e : t.take_events()) told = told || e.kind == EventKind::inverted;
  EXPECT_TRUE(told);
}

TEST(Simulation, MeshesInArraysAreThoseOfAFile) {
  // The box again, by its own arrays.
  Simulation s(standing_box());
  SceneBuilder scene;
  MeshArrays arrays;
  arrays.nodes.assign(s.rest_positions().begin(), s.rest_positions().end());
  arrays.tets.assign(s.tets().begin(), s.tets().end());
  scene.add_body({.name = "box", .arrays = arrays, .material = {.young = 5e3}});
  scene.add_pin({.name = "floor", .select = {.side = "-y"}});
  Simulation own(scene);
  s.advance(0.1);
  own.advance(0.1);
  EXPECT_EQ(own.hash(), s.hash());
}

TEST(Simulation, ABuilderShowsItsTomlWhichIsTheSameScene) {
  SceneBuilder scene = standing_box();
  scene.add_obstacle(ball).set_ground({.point = {{0.0, -1.0, 0.0}}}).set_gravity({0.0, -5.0, 0.0});
  Simulation built(scene);
  Simulation read = Simulation::from_text(scene.toml());
  built.advance(0.05);
  read.advance(0.05);
  EXPECT_EQ(built.hash(), read.hash());
}

}  // namespace
}  // namespace sinew
