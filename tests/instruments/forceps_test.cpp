#include <gtest/gtest.h>
#include <sinew/error.h>
#include <sinew/forceps.h>
#include <sinew/sinew.h>

#include <algorithm>
#include <cmath>

namespace sinew {
namespace {

// A block of 20 x 10 x 10 mm, 2.1 g, that floats between open jaws.
SceneBuilder block(double density = 1060.0) {
  SceneBuilder scene;
  scene.set_gravity({0.0, 0.0, 0.0});
  scene.add_body({.name = "block",
                  .shape = "box",
                  .cells = {{8, 4, 4}},
                  .size = {{0.02, 0.01, 0.01}},
                  .material = {.density = density, .young = 50e3, .poisson = 0.45, .drag = 2.0}});
  return scene;
}

ForcepsDescription jaws() {
  return {.length = 0.012,
          .width = 0.012,
          .opening = 0.016,
          .friction = 0.3,
          .pose = {.center = {0.006, 0.0, 0.0}}};
}

double middle(const Simulation& simulation, std::size_t axis) {
  double sum = 0.0;
  for (const Point& x : simulation.positions()) sum += x[axis];
  return sum / static_cast<double>(simulation.positions().size());
}

TEST(Forceps, CloseWithAForce) {
  Simulation simulation{block()};
  Forceps forceps(simulation, jaws());
  EXPECT_EQ(forceps.opening(), 0.016);
  forceps.close_with(0.5);
  advance(simulation, {&forceps}, 1.0);
  EXPECT_NEAR(forceps.grip(), 0.5, 0.02);
  EXPECT_LT(forceps.opening(), 0.01);
  forceps.open_to(0.016);
  advance(simulation, {&forceps}, 0.5);
  EXPECT_NEAR(forceps.opening(), 0.016, 1e-12);
  EXPECT_EQ(forceps.grip(), 0.0);
}

TEST(Forceps, CarryWhatTheyHold) {
  Simulation simulation{block()};
  Forceps forceps(simulation, jaws());
  forceps.close_with(0.5);
  advance(simulation, {&forceps}, 0.5);
  const double before = middle(simulation, 0);
  forceps.move({.center = {0.036, 0.02, 0.0}});
  advance(simulation, {&forceps}, 0.5);
  EXPECT_NEAR(middle(simulation, 0), before + 0.03, 0.002);
  EXPECT_NEAR(middle(simulation, 1), 0.02, 0.002);
}

// Two jaws hold up to 2 mu N: a force along them grows until the block slips.
TEST(Forceps, SlipAtCoulombsLoad) {
  Simulation simulation{block()};
  Forceps forceps(simulation, jaws());
  const double force = 0.5, friction = 0.3, mass = 0.02 * 0.01 * 0.01 * 1060.0;
  forceps.close_with(force);
  advance(simulation, {&forceps}, 1.0);
  const double start = middle(simulation, 2);
  double weight = 0.0;
  while (weight < 2.0 * force && std::abs(middle(simulation, 2) - start) < 1e-3) {
    weight += 0.002;
    simulation.set_gravity({0.0, 0.0, -weight / mass});
    advance(simulation, {&forceps}, 0.01);
  }
  EXPECT_NEAR(weight, 2.0 * friction * force, 0.05 * 2.0 * friction * force);
}

TEST(Forceps, TwoAtOnce) {
  Simulation simulation{block()};
  ForcepsDescription left = jaws(), right = jaws();
  left.name = "left";
  left.length = right.length = 0.006;
  left.pose = {{-0.003, 0.0, 0.0}, {0.0, 0.0, 1.0, 0.0}};  // the tips look to -x
  right.name = "right";
  right.pose = {.center = {0.009, 0.0, 0.0}};
  left.pose.center = {-0.009, 0.0, 0.0};
  Forceps a(simulation, left), b(simulation, right);
  a.close_with(0.4);
  b.close_with(0.4);
  advance(simulation, {&a, &b}, 0.5);
  EXPECT_NEAR(a.grip(), 0.4, 0.04);
  EXPECT_NEAR(b.grip(), 0.4, 0.04);
  b.move({.center = {0.011, 0.0, 0.0}});  // stretches the block
  advance(simulation, {&a, &b}, 0.5);
  EXPECT_GT(a.wrench().force[0], 0.05);
  EXPECT_LT(b.wrench().force[0], -0.05);
}

TEST(Forceps, RefusesWhatCannotBe) {
  Simulation simulation{block()};
  EXPECT_THROW(Forceps(simulation, {.length = 0.0}), Error);
  EXPECT_THROW(Forceps(simulation, {.friction = -1.0}), Error);
  Forceps forceps(simulation, jaws());
  EXPECT_THROW(Forceps(simulation, jaws()), Error);
  EXPECT_THROW(forceps.close_with(0.0), Error);
  EXPECT_THROW(forceps.open_to(1.0), Error);
  EXPECT_THROW(advance(simulation, {&forceps}, -1.0), Error);
}

}  // namespace
}  // namespace sinew
