// The ground as explicit steps have it: the plane obstacle of make_ground().
#include <gtest/gtest.h>

#include <cmath>

#include "sinew/contact/colliders.h"
#include "sinew/contact/contact_solver.h"
#include "sinew/forces/assemble.h"

namespace sinew {
namespace {

// One free mass over the plane y = 0 under gravity g, advanced as the stepper does.
struct Ball {
  explicit Ball(const Vec3& x, const Vec3& v, double restitution, double friction) {
    Body body;
    body.name = "ball";
    body.nodes = {0, 1};
    model.bodies = {body};
    model.rest_position = {x};
    model.mass = {2.0};
    model.drag = {0.0};
    model.start_velocity = {v};
    model.obstacles.push_back(make_ground(Vec3::Zero(), Vec3::UnitY(), restitution, friction));
    build_skin(model);
    finish(model);
    state = initial_state(model);
    state.obstacle_force.assign(1, Vec3::Zero());
  }
  void step(double h) {
    const std::vector<Vec3> force = {2.0 * Vec3(0, -g, 0)};
    const std::vector<Vec3> before = state.position;
    state.half_velocity[0] += 0.5 * (state.last_step + h) * Vec3(0, -g, 0);
    state.position[0] += h * state.half_velocity[0];
    std::vector<Contact> found;
    find_collider_contacts(model, initial_controls(model), before, state.position, 0.0, h, 0.0,
                           found);
    const ContactReport r = solve_contacts(model, found, force, Vec3(0, -g, 0), h, state, scratch);
    contacts += r.contacts;
    dissipated += r.dissipated;
    state.last_step = h;
  }
  double top(double h, int steps) {  // highest point over the steps to come
    double y = 0.0;
    for (int i = 0; i < steps; ++i) {
      step(h);
      y = std::max(y, state.position[0].y());
    }
    return y;
  }
  static constexpr double g = 10.0;
  Model model;
  State state;
  ContactScratch scratch;
  Index contacts = 0;
  double dissipated = 0.0;
};

TEST(Ground, RestitutionOneKeepsTheHeightForEver) {
  Ball ball(Vec3(0, 1, 0), Vec3::Zero(), 1.0, 0.0);
  const double h = 0.00317;
  ball.top(h, 100'000);  // some 350 bounces
  EXPECT_NEAR(ball.top(h, 1000), 1.0, 2e-5);
  EXPECT_NEAR(ball.dissipated, 0.0, 1e-9);
}

TEST(Ground, RestitutionHalvesTheSpeedAndQuartersTheHeight) {
  Ball ball(Vec3(0, 1, 0), Vec3::Zero(), 0.5, 0.0);
  const double h = 1e-4;
  while (ball.contacts == 0) ball.step(h);
  // The half-step velocity of an impact is right to g h / 2.
  EXPECT_NEAR(ball.top(h, 3000), 0.25, 2e-4);
  EXPECT_NEAR(ball.dissipated, 2.0 * 10.0 * 0.75, 4e-3);
}

TEST(Ground, ComesToRestOnThePlaneAndStaysThere) {
  Ball ball(Vec3(0, 0.1, 0), Vec3::Zero(), 0.5, 0.5);
  for (int i = 0; i < 20'000; ++i) ball.step(1e-3);
  EXPECT_NEAR(ball.state.position[0].y(), 0.0, 1e-18);
  EXPECT_NEAR(ball.dissipated, 2.0 * 10.0 * 0.1, 0.01);
}

TEST(Ground, CoulombFrictionStopsASlidingBodyAfterVSquaredOver2MuG) {
  Ball ball(Vec3(0, 0, 0), Vec3(2, 0, 0), 0.0, 0.4);
  for (int i = 0; i < 10'000; ++i) ball.step(1e-3);
  EXPECT_NEAR(ball.state.position[0].x(), 4.0 / (2 * 0.4 * 10.0), 2e-3);
  EXPECT_EQ(ball.state.half_velocity[0].norm(), 0.0);
  EXPECT_NEAR(ball.dissipated, 0.5 * 2.0 * 4.0, 0.02);
}

TEST(Ground, SlopeHoldsBelowTheFrictionAngleAndLetsGoAboveIt) {
  for (const bool holds : {true, false}) {
    Ball ball(Vec3(0, 0, 0), Vec3::Zero(), 0.0, 0.5);
    const double angle = std::atan(0.5) + (holds ? -0.01 : 0.01);
    ball.model.obstacles[0] =
        make_ground(Vec3::Zero(), Vec3(std::sin(angle), std::cos(angle), 0), 0.0, 0.5);
    for (int i = 0; i < 1000; ++i) ball.step(1e-3);
    const double slid = ball.state.position[0].norm();
    if (holds) {
      EXPECT_LT(slid, 1e-9);
    }
    // g (sin a - mu cos a) t^2 / 2
    if (!holds) {
      EXPECT_NEAR(slid, 5.0 * (std::sin(angle) - 0.5 * std::cos(angle)), 2e-3);
    }
  }
}

TEST(Ground, NodesThatStartBelowAreLedOutSlowly) {
  Ball ball(Vec3(0, -0.02, 0), Vec3::Zero(), 0.0, 0.0);
  double fastest = 0.0;
  for (int i = 0; i < 1000; ++i) {
    ball.step(1e-3);
    fastest = std::max(fastest, ball.state.half_velocity[0].y());
  }
  EXPECT_NEAR(ball.state.position[0].y(), 0.0, 1e-12);
  EXPECT_LE(fastest, 0.1 + 1e-12);
}

}  // namespace
}  // namespace sinew
