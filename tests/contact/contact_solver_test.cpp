#include "sinew/contact/contact_solver.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sinew/forces/assemble.h"

namespace sinew {
namespace {

constexpr double h = 1e-3;

// Free masses without forces but those given, advanced as the stepper does.
struct Masses {
  Masses(const std::vector<Vec3>& x, const std::vector<Vec3>& v, const std::vector<double>& m) {
    Body body;
    body.name = "masses";
    body.nodes = {0, static_cast<Index>(x.size())};
    model.bodies = {body};
    model.rest_position = x;
    model.mass = m;
    model.drag.assign(x.size(), 0.0);
    model.start_velocity = v;
    finish(model);
    state = initial_state(model);
    force.assign(x.size(), Vec3::Zero());
  }
  // One step into the contacts; their gaps are those of the predicted positions.
  ContactReport step(std::vector<Contact> contacts) {
    for (std::size_t i = 0; i < force.size(); ++i) {
      if (model.inverse_mass[i] == 0.0) continue;
      state.half_velocity[i] += 0.5 * (state.last_step + h) * model.inverse_mass[i] * force[i];
      state.position[i] += h * state.half_velocity[i];
    }
    for (Contact& c : contacts) c.gap = contact_gap(c, state.position);
    state.obstacle_force.assign(1, Vec3::Zero());
    const ContactReport report =
        solve_contacts(model, contacts, force, Vec3::Zero(), h, state, scratch);
    state.last_step = h;
    return report;
  }
  Vec3 momentum() const {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < force.size(); ++i) sum += model.mass[i] * state.half_velocity[i];
    return sum;
  }
  double kinetic() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < force.size(); ++i) {
      sum += 0.5 * model.mass[i] * state.half_velocity[i].squaredNorm();
    }
    return sum;
  }
  Model model;
  State state;
  ContactScratch scratch;
  std::vector<Vec3> force;
};

// Node 0 above the triangle 1, 2, 3 in the plane y = 0.
Contact node_on_triangle(double friction, double restitution) {
  Contact c;
  c.node = {0, 1, 2, 3};
  c.weight = {1.0, -0.5, -0.3, -0.2};
  c.count = 4;
  c.normal = Vec3::UnitY();
  c.friction = friction;
  c.restitution = restitution;
  return c;
}

Masses node_and_triangle(const Vec3& velocity, double height = 0.0) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 0, -1);
  const Vec3 x = 0.5 * a + 0.3 * b + 0.2 * c + Vec3(0, height, 0);
  return {{x, a, b, c}, {velocity, Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}, {1.0, 2.0, 3.0, 4.0}};
}

TEST(ContactSolver, NodeAndTriangleKeepTheirMomentum) {
  Masses m = node_and_triangle(Vec3(0.3, -1.0, 0.2));
  const Vec3 before = m.momentum();
  const double energy = m.kinetic();
  const ContactReport report = m.step({node_on_triangle(0.4, 0.0)});
  EXPECT_EQ(report.contacts, 1);
  EXPECT_LT((m.momentum() - before).norm(), 1e-14);
  EXPECT_NEAR(report.dissipated, energy - m.kinetic(), 1e-12);
  EXPECT_GT(report.friction, 0.0);
  EXPECT_LT(report.friction, report.dissipated);
  EXPECT_NEAR(contact_gap(node_on_triangle(0, 0), m.state.position), 0.0, 1e-15);
  EXPECT_LE(report.deepest, 1e-15);
}

TEST(ContactSolver, RestitutionTurnsTheRelativeVelocityRound) {
  Masses m = node_and_triangle(Vec3(0.0, -1.0, 0.0), 2e-4);
  const double energy = m.kinetic();
  const Contact c = node_on_triangle(0.0, 1.0);
  m.step({c});
  Vec3 v = Vec3::Zero();
  for (std::size_t a = 0; a < 4; ++a) v += c.weight[a] * m.state.half_velocity[a];
  EXPECT_NEAR(v.y(), 1.0, 1e-12);
  EXPECT_NEAR(m.kinetic(), energy, 1e-12);
  // It turns round where the step starts.
  EXPECT_NEAR(contact_gap(c, m.state.position), 2e-4 + h, 1e-12);
}

TEST(ContactSolver, FrictionTakesAtMostMuTimesTheNormalImpulse) {
  Masses m = node_and_triangle(Vec3(2.0, -1.0, 0.0));
  const Contact c = node_on_triangle(0.25, 0.0);
  const double mass = 1.0 / (1.0 + 0.25 / 2.0 + 0.09 / 3.0 + 0.04 / 4.0);
  const Vec3 before = m.state.half_velocity[0];
  m.step({c});
  const Vec3 impulse = m.state.half_velocity[0] - before;  // of a mass of 1
  EXPECT_NEAR(impulse.y(), mass, 1e-12);
  EXPECT_NEAR(impulse.x(), -0.25 * mass, 1e-12);
}

TEST(ContactSolver, SharedNodesAreSolvedTogether) {
  // A mass in the corner of two planes, and one on its back: three contacts, one answer.
  Masses m({Vec3(0, 0, 0), Vec3(0, 1, 0)}, {Vec3(-1, -2, 0), Vec3(0, -3, 0)}, {1.0, 5.0});
  Contact wall, floor, pair;
  wall.node[0] = floor.node[0] = 0;
  wall.weight[0] = floor.weight[0] = 1.0;
  wall.count = floor.count = 1;
  wall.normal = Vec3::UnitX();
  floor.normal = Vec3::UnitY();
  pair.node = {1, 0, -1, -1};
  pair.weight = {1.0, -1.0, 0.0, 0.0};
  pair.anchor = Vec3(0, 1, 0);
  pair.count = 2;
  const double energy = m.kinetic();
  const ContactReport report = m.step({wall, floor, pair});
  EXPECT_EQ(report.contacts, 3);
  EXPECT_LT(m.state.half_velocity[0].norm(), 1e-2);
  EXPECT_LT(m.state.half_velocity[1].norm(), 1e-2);
  EXPECT_LT(report.deepest, 1e-5);
  EXPECT_NEAR(report.dissipated, energy - m.kinetic(), 1e-9);
}

TEST(ContactSolver, CollidersThatMoveDoWorkAndFeelTheForce) {
  Masses m({Vec3(0, 0, 0)}, {Vec3(0, 0, 0)}, {2.0});
  m.state.last_step = h;
  Contact c;
  c.node[0] = 0;
  c.weight[0] = 1.0;
  c.count = 1;
  c.anchor_displacement = Vec3(0, 3.0 * h, 0);  // a piston at 3 m/s
  c.anchor = c.anchor_displacement;
  c.id.owner = 0;
  const ContactReport report = m.step({c});
  EXPECT_NEAR(m.state.half_velocity[0].y(), 3.0, 1e-12);
  EXPECT_NEAR(m.state.position[0].y(), 3.0 * h, 1e-15);
  EXPECT_NEAR(report.work_in, 18.0, 1e-9);
  EXPECT_NEAR(report.work_in - report.dissipated, m.kinetic(), 1e-9);
  EXPECT_NEAR(m.state.obstacle_force[0].y(), -6.0 / h, 1e-9);
}

// Without forces Newton's law of restitution would make energy of these, step by step, without end.
TEST(ContactSolver, BouncesThatShareNodesMakeNoEnergy) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto vec = [&] { return Vec3(unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5); };
  Masses m({vec(), vec(), vec(), vec()}, {vec(), vec(), vec(), vec()}, {1.0, 2.0, 3.0, 4.0});
  const double energy = m.kinetic();
  double dissipated = 0.0;
  for (int step = 0; step < 300; ++step) {
    std::vector<Contact> contacts;
    for (Index a = 0; a < 4; ++a) {
      for (Index b = 0; b < a; ++b) {
        Contact c;
        c.node = {a, b, -1, -1};
        c.weight = {1.0, -1.0, 0.0, 0.0};
        c.count = 2;
        c.restitution = 1.0;
        c.normal = vec().normalized();
        c.anchor = contact_offset(c, m.state.position);  // gap 0
        contacts.push_back(c);
      }
    }
    dissipated += m.step(contacts).dissipated;
    ASSERT_LT(m.kinetic(), 1.5 * energy) << step;
    ASSERT_NEAR(dissipated, energy - m.kinetic(), 1e-9 * energy);
  }
}

TEST(ContactSolver, PinnedNodesStay) {
  Masses m = node_and_triangle(Vec3(0, -1, 0));
  for (const Index i : {1, 2, 3}) m.model.inverse_mass[uz(i)] = 0.0;
  m.step({node_on_triangle(0.5, 0.0)});
  EXPECT_EQ(m.state.position[1], Vec3(0, 0, 0));
  EXPECT_NEAR(m.state.position[0].y(), 0.0, 1e-15);
  for (auto& w : m.model.inverse_mass) w = 0.0;
  EXPECT_EQ(m.step({node_on_triangle(0.5, 0.0)}).contacts, 0);
}

constexpr ContactId lying = {ContactKind::node_shape, -1, 0, -1};

// A mass of 2 kg that lies on a plane, pulled aside by half its weight.
Masses lying_mass() {
  Masses m({Vec3(0, 0, 0)}, {Vec3(0, 0, 0)}, {2.0});
  m.force[0] = Vec3(10.0, -20.0, 0.0);
  return m;
}

Contact mass_on_plane(double friction, const ContactId& id) {
  Contact c;
  c.node[0] = 0;
  c.weight[0] = 1.0;
  c.count = 1;
  c.friction = friction;
  c.id = id;
  return c;
}

TEST(ContactSolver, BeginsWithWhatItPushedWithInTheStepBefore) {
  Masses m = lying_mass();
  EXPECT_GT(m.step({mass_on_plane(0.6, lying)}).sweeps, 1);
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(m.state.reactions.contacts.size(), 1U);
    const ContactForce& p = m.state.reactions.contacts[0];
    EXPECT_EQ(p.id, lying);
    EXPECT_LT((p.force - Vec3(-10.0, 20.0, 0.0)).norm(), 1e-9);  // also after a first half-step
    EXPECT_EQ(m.step({mass_on_plane(0.6, lying)}).sweeps, 1);
    EXPECT_LT(m.state.half_velocity[0].norm(), 1e-12);
  }
  EXPECT_EQ(m.step({}).contacts, 0);
  EXPECT_TRUE(m.state.reactions.contacts.empty());
}

TEST(ContactSolver, ANodeThatGoesOnToTheNextTriangleKeepsItsPush) {
  Masses m = lying_mass();
  const auto on = [](Index body, Index triangle) {
    return mass_on_plane(0.6, {ContactKind::node_triangle, body, 5, triangle});
  };
  m.step({on(1, 7)});
  EXPECT_EQ(m.step({on(1, 9)}).sweeps, 1);
  EXPECT_EQ(m.state.reactions.contacts.at(0).id, on(1, 9).id);
  EXPECT_GT(m.step({on(2, 9)}).sweeps, 1);  // something else
}

TEST(ContactSolver, FrictionsConeHoldsWhateverItBeginsWith) {
  for (const Vec3& stale :
       {Vec3(-500.0, 20.0, 0.0), Vec3(0.0, -30.0, 90.0), Vec3(3.0, 900.0, 2.0)}) {
    Masses m = lying_mass();
    m.state.last_step = h;
    ContactForce p;
    p.id = lying;
    p.node[0] = 0;
    p.weight[0] = 1.0;
    p.force = stale;
    m.state.reactions.contacts = {p};
    m.step({mass_on_plane(0.3, lying)});
    const Vec3 impulse = 2.0 * m.state.half_velocity[0] - h * m.force[0];
    EXPECT_NEAR(impulse.y(), 20.0 * h, 1e-12);
    EXPECT_NEAR(impulse.x(), -0.3 * 20.0 * h, 1e-12);
    EXPECT_NEAR(impulse.z(), 0.0, 1e-12);
  }
}

TEST(ContactSolver, RandomTanglesOfContactsKeepMomentumAndNeverAddEnergy) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto vec = [&] { return Vec3(unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5); };
  for (int trial = 0; trial < 400; ++trial) {
    const double restitution = trial < 200 ? 0.0 : 0.005 * (trial - 199);
    std::vector<Vec3> x, v;
    std::vector<double> mass;
    for (int i = 0; i < 12; ++i) {
      x.push_back(vec());
      v.push_back(4.0 * vec());
      mass.push_back(0.1 + unit(random));
    }
    Masses m(x, v, mass);
    std::vector<Contact> contacts;
    for (int k = 0; k < 10; ++k) {
      Contact c = node_on_triangle(unit(random), restitution);
      for (int a = 0; a < 4; ++a) c.node[static_cast<std::size_t>(a)] = (5 * k + 3 * a) % 12;
      c.normal = vec().normalized();
      double rest = 1.0;
      for (std::size_t a = 1; a < 3; ++a) {
        c.weight[a] = -rest * unit(random);
        rest += c.weight[a];
      }
      c.weight[3] = -rest;
      c.anchor = contact_offset(c, x) + 1e-4 * vec();  // almost in contact
      contacts.push_back(c);
    }
    const Vec3 before = m.momentum();
    const double energy = m.kinetic();
    const ContactReport report = m.step(contacts);
    EXPECT_LT((m.momentum() - before).norm(), 1e-12);
    EXPECT_LT(m.kinetic(), energy * (restitution > 0.0 ? 1.05 : 1.001)) << restitution;
    EXPECT_TRUE(std::isfinite(report.dissipated));
  }
}

}  // namespace
}  // namespace sinew
