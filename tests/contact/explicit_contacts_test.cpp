#include "sinew/contact/explicit_contacts.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sinew/contact/colliders.h"
#include "sinew/forces/assemble.h"
#include "sinew/forces/obstacles.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

constexpr double step_length = 1e-3;

// A box of tissue that stands on the plane y = 0; what it is predicted to do is made up.
struct Standing {
  explicit Standing(double friction = 0.5) {
    model = test::tissue_box({}, {2, 2, 2});
    Obstacle floor;
    floor.name = "floor";
    floor.shape = shapes::Plane{};
    floor.center = Vec3(0, -0.05, 0);
    floor.friction = friction;
    add_obstacle(model, floor);
    floor.name = "a wall far away";  // with one plane alone contacts share no nodes
    floor.center = Vec3(0, -9, 0);
    add_obstacle(model, floor);
    build_skin(model);
    finish(model);
    state = initial_state(model);
    state.last_step = step_length;
    before = state.position;
    force.assign(before.size(), Vec3(0, -1, 0));
    for (Index i = 0; i < model.body_node_count(); ++i)
      if (before[uz(i)].y() < -0.0499) bottom.push_back(i);
  }
  // Predicted: it falls by `depth` [m] in this step, as its force has it.
  void fall(double depth) {
    for (std::size_t i = 0; i < before.size(); ++i) {
      state.position[i] = before[i] - Vec3(0, depth, 0);
      state.half_velocity[i] = Vec3(0, -depth / step_length, 0);
      force[i] = Vec3(0, -depth / (step_length * step_length * model.inverse_mass[i]), 0);
    }
  }
  // The node was held by that multiple of its force in the step before.
  void held(Index node, double multiple, const Vec3& direction = Vec3::UnitY()) {
    ContactForce p;
    p.id = {ContactKind::node_shape, 0, node, -1};
    p.node[0] = node;
    p.weight[0] = 1.0;
    p.force = multiple * force[uz(node)].norm() * direction;
    state.reactions.contacts.push_back(p);
  }
  ContactReport step(ExplicitContacts& contacts) {
    return contacts.step(initial_controls(model), before, force, step_length, state);
  }
  ContactReport step() {
    ExplicitContacts contacts(model);
    return step(contacts);
  }
  double reach() { return ExplicitContacts(model).finder().explicit_reach(); }

  Model model;
  State state;
  std::vector<Vec3> before, force;
  std::vector<Index> bottom;
};

TEST(ExplicitContacts, NothingTouchesWhereNothingCan) {
  Model m = test::tissue_box({}, {1, 1, 1});
  finish(m);
  EXPECT_FALSE(ExplicitContacts::any(m));
  EXPECT_TRUE(ExplicitContacts::any(Standing().model));
}

TEST(ExplicitContacts, WhatFallsInStandsOnThePlane) {
  Standing s;
  s.fall(3.0 * s.reach());
  const ContactReport report = s.step();
  EXPECT_EQ(report.contacts, std::ssize(s.bottom));
  EXPECT_LT(report.deepest, 1e-15);
  for (const Index i : s.bottom) EXPECT_NEAR(s.state.position[uz(i)].y(), -0.05, 1e-15);
  EXPECT_EQ(std::ssize(s.state.reactions.contacts), std::ssize(s.bottom));
  EXPECT_LT(s.state.obstacle_force[0].y(), 0.0);
}

// One of those that pushed is led out of reach by its push: only what is found again may stay as it
// is found. This contact was lost once, since others of the same obstacle were found.
TEST(ExplicitContacts, AContactThatIsLostWhereItIsHeldIsFoundWhereItIsPredicted) {
  Standing s;
  s.fall(2.0 * s.reach());
  for (const Index i : s.bottom) s.held(i, 1.0);
  const Index lost = s.bottom[3];
  s.force[uz(lost)] *= 2.5;  // as much of its push counts, which leads it out of reach
  s.state.reactions.contacts[3].force *= 2.5;
  const ContactReport report = s.step();
  EXPECT_EQ(report.contacts, std::ssize(s.bottom));
  EXPECT_LT(report.deepest, 1e-15);
  EXPECT_NEAR(s.state.position[uz(lost)].y(), -0.05, 1e-15);
}

TEST(ExplicitContacts, GapsAreThoseOfThePredictedPositions) {
  Standing s;
  const double depth = 0.3 * s.reach();
  s.fall(depth);
  for (const Index i : s.bottom) s.held(i, 1.0);
  const std::vector<Vec3> predicted = s.state.position;
  ExplicitContacts contacts(s.model);
  s.step(contacts);
  ASSERT_EQ(contacts.contacts().size(), s.bottom.size());
  for (const Contact& c : contacts.contacts()) {
    EXPECT_NEAR(c.gap, -depth, 1e-15);
    EXPECT_EQ(c.gap, contact_gap(c, predicted));
  }
}

// Held or not, found here or there: it is the start of the solver only.
TEST(ExplicitContacts, WhatWasHeldBeforeChangesNothingButTheStart) {
  Standing fresh;
  fresh.fall(2.0 * fresh.reach());
  fresh.step();
  for (const double multiple : {0.3, 1.0, 4.0, 1e6}) {
    Standing s;
    s.fall(2.0 * s.reach());
    for (const Index i : s.bottom) s.held(i, multiple);
    s.step();
    for (std::size_t i = 0; i < s.before.size(); ++i)
      EXPECT_LT((s.state.position[i] - fresh.state.position[i]).norm(), 1e-9) << multiple;
  }
}

TEST(ExplicitContacts, KeepsNothingFromStepToStep) {
  Standing s;
  s.fall(0.5 * s.reach());
  for (const Index i : s.bottom) s.held(i, 0.9);
  const State start = s.state;
  ExplicitContacts used(s.model);
  s.step(used);
  const std::vector<Vec3> first = s.state.position;
  s.state = start;
  for (Vec3& x : s.state.position) x.y() += 1.0;  // elsewhere
  s.step(used);
  s.state = start;
  s.step(used);
  EXPECT_EQ(s.state.position, first);
}

TEST(ExplicitContacts, WorkAndLossesGoToTheAccount) {
  Standing s;
  s.fall(5.0 * s.reach());
  const ContactReport report = s.step();
  EXPECT_NE(report.dissipated, 0.0);
  EXPECT_EQ(s.state.energy.dissipated, report.dissipated);
  EXPECT_EQ(s.state.energy.work_in, report.work_in);
}

}  // namespace
}  // namespace sinew
