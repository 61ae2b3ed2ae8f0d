#include "sinew/solver/constraints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sinew/base/error.h"
#include "sinew/base/parallel.h"
#include "sinew/base/random.h"
#include "sinew/contact/colliders.h"
#include "sinew/forces/inversion_recovery.h"
#include "sinew/forces/stiffness.h"
#include "sinew/forces/strain_limits.h"
#include "sinew/forces/terms.h"
#include "sinew/forces/volume.h"
#include "sinew/solver/bound.h"
#include "sinew/solver/implicit.h"
#include "sinew/solver/static.h"
#include "tests/support/effort.h"
#include "tests/support/forces.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

using test::point_masses;
using test::tissue_box;

constexpr double frame = 1.0 / 60.0;

Material soft(double young = 2e4, double poisson = 0.4) {
  Material material;
  material.young = young;
  material.poisson = poisson;
  material.damping_ratio = 0.1;
  return material;
}

void stand_on_ground(Model& m, const Vec3& point, const Vec3& normal, double restitution,
                     double friction) {
  m.obstacles.push_back(make_ground(point, normal, restitution, friction));
  build_skin(m);
}

// A box of 0.1 m whose lowest nodes are `height` above the ground y = 0.
Model box_above_ground(const Material& material, double height, double friction, int cells = 2) {
  Model m = tissue_box(material, {cells, cells, cells});
  stand_on_ground(m, Vec3(0, -0.05 - height, 0), Vec3::UnitY(), 0.0, friction);
  finish(m);
  return m;
}

double lowest(const Model& m, const State& s) {
  double low = no_limit;
  for (Index i = 0; i < m.body_node_count(); ++i) {
    const Obstacle& ground = m.obstacles.back();
    low = std::min(low, ground.rotation.col(1).dot(s.position[uz(i)] - ground.center));
  }
  return low;
}

double weight(const Model& m) {
  double mass = 0.0;
  for (const double x : m.mass) mass += x;
  return mass * m.start_gravity.norm();
}

// --- the formulas ---

TEST(Bound, PullIsTheDerivativeOfTheEnergy) {
  for (const double q : {-0.3, -0.01, 0.5, 1.02, 1.4}) {
    for (const double p : {-2.0, 0.0, 3.0}) {
      const double e = 1e-6, k = 7.0;
      const auto energy = [&](double x) { return bound_energy(x, 0.0, 1.0, k, p); };
      const auto force = [&](double x) { return bound_force(x, 0.0, 1.0, k, p); };
      EXPECT_NEAR(force(q), (energy(q + e) - energy(q - e)) / (2 * e), 1e-7);
      EXPECT_NEAR(bound_stiffness(q, 0.0, 1.0, k, p), (force(q + e) - force(q - e)) / (2 * e),
                  1e-7);
    }
  }
}

TEST(Bound, FrictionIsTheDerivativeOfItsEnergyAndAtMostItsShareOfThePush) {
  const Vec3 n = Vec3(1, 2, 2) / 3.0;
  const Vec3 a = Vec3(2, 1, -2) / 3.0, b = n.cross(a);
  const double k = 50.0, r = 0.7, e = 1e-6;
  const Vec3 p = 0.2 * a - 0.3 * b;
  for (const Vec3& u : {Vec3(0.001 * a), Vec3(0.1 * a - 0.04 * b), Vec3(-0.5 * b)}) {
    const Vec3 s = friction_force(u, r, k, p);
    EXPECT_LE(s.norm(), r * (1 + 1e-12));
    const Mat3 block = friction_stiffness(u, r, k, p, n);
    for (const Vec3& d : {a, b}) {
      EXPECT_NEAR(
          s.dot(d),
          (friction_energy(u + e * d, r, k, p) - friction_energy(u - e * d, r, k, p)) / (2 * e),
          1e-7);
      const Vec3 change =
          (friction_force(u + e * d, r, k, p) - friction_force(u - e * d, r, k, p)) / (2 * e);
      EXPECT_LE((block * d - change).norm(), 1e-6);
    }
    EXPECT_LE((block * n).norm(), 1e-12);
  }
}

// --- the energies on a body ---

// A crumpled box in which every kind of condition pulls, each with a multiplier.
struct Crumpled {
  Model model = tissue_box(soft(), {2, 2, 2});
  State state;
  std::vector<Vec3> from;

  Crumpled() {
    stand_on_ground(model, Vec3(0, -0.03, 0), Vec3(0.1, 1, 0).normalized(), 0.0, 0.5);
    for (std::size_t s = 0; s < model.springs.size(); ++s) {
      model.stretch_limit[s] = model.compress_limit[s] = 0.05;
    }
    std::fill(model.volume_limit.begin(), model.volume_limit.end(), 0.05);
    model.pins.push_back({"top", test::nodes_at(model, 1, 0.05), {}});
    finish(model);
    state = initial_state(model);
    from = state.position;
    for (std::size_t i = 0; i < from.size(); ++i) {
      state.position[i] += 0.01 * (random_point(i) - Vec3::Constant(0.5));
    }
    for (const Index i : model.skin.nodes) {
      if (model.inverse_mass[uz(i)] == 0.0) continue;
      state.reactions.contacts.push_back({{ContactKind::node_shape, 0, i, -1},
                                          {i, -1, -1, -1},
                                          {1.0, 0.0, 0.0, 0.0},
                                          Vec3(0.02, 0.2, 0.03)});
    }
    state.reactions.tension.assign(model.limited.size(), 0.3);
    state.reactions.pressure.assign(model.cell_volume.size(), -40.0);
  }
};

TEST(Constraints, ForceAndTangentAreTheDerivativesOfTheEnergy) {
  Crumpled c;
  ASSERT_GT(c.model.limited.size(), 20U);
  ASSERT_TRUE(c.model.has_volume_limit);
  Constraints constraints(c.model, 3600.0, 60.0, true);
  constraints.start(initial_controls(c.model), c.state, &c.from, 1.0 / 60.0);
  std::vector<Vec3> u(c.from.size());
  for (std::size_t i = 0; i < u.size(); ++i) {
    u[i] = random_point(1000 + i) - Vec3::Constant(0.5);
    if (c.model.inverse_mass[i] == 0.0) u[i].setZero();
  }
  const auto at = [&](double e) {
    std::vector<Vec3> x = c.state.position;
    for (std::size_t i = 0; i < u.size(); ++i) x[i] += e * u[i];
    return x;
  };
  const auto energy = [&](double e) {
    return constraints.value(at(e), volumes_of_tets(c.model, at(e)));
  };
  const auto force = [&](double e) {
    const std::vector<Vec3> x = at(e);
    std::vector<Vec3> f(x.size(), Vec3::Zero());
    constraints.add_forces(x, compute_tet_volumes(c.model, x), f);
    return f;
  };
  const double e = 1e-7;
  double slope = 0.0;
  const std::vector<Vec3> f = force(0.0);
  for (std::size_t i = 0; i < u.size(); ++i) slope -= f[i].dot(u[i]);
  EXPECT_NEAR(slope, (energy(e) - energy(-e)) / (2 * e), 1e-5 * std::abs(slope));

  // The product takes the curvature of the volumes from the material's own: with and without.
  std::vector<Vec3> with(u.size()), without(u.size());
  const std::vector<Vec3> x = at(0.0);
  TetState tets = compute_tet_state(c.model, x);
  const Controls controls = initial_controls(c.model);
  const auto product = [&](std::vector<Vec3>& out) {
    TangentProduct().times({c.model, controls, x}, tets, 1.0, 0.0, u, Tangent::full, out);
  };
  product(without);
  constraints.linearise(x, tets);
  for (std::size_t t = 0; t < tets.pressure.size(); ++t)
    tets.pressure[t] += constraints.tet_pressure()[t];
  product(with);
  constraints.add_stiffness_times(tets, u, with);
  const std::vector<Vec3> plus = force(e), minus = force(-e);
  double error = 0.0, size = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    if (c.model.inverse_mass[i] == 0.0) continue;
    const Vec3 change = -(plus[i] - minus[i]) / (2 * e);
    error += (with[i] - without[i] - change).squaredNorm();
    size += change.squaredNorm();
  }
  EXPECT_LE(std::sqrt(error / size), 1e-4);
}

// --- steps ---

TEST(Constraints, ADroppedBoxComesToRestOnTheGround) {
  for (const double young : {1e4, 1e6, 1e9}) {
    if (test::sanitized && young != 1e6) continue;
    Material material = soft(young);
    material.drag = 2.0;
    const Model m = box_above_ground(material, 0.02, 0.5);
    State s = initial_state(m);
    ImplicitStepper stepper(m);
    double before = test::energies_at(m, initial_controls(m), s).gravity;
    for (int i = 0; i < 150; ++i) {
      const StepReport report = stepper.step(frame, initial_controls(m), {}, s);
      EXPECT_TRUE(report.limits_met);
      EXPECT_GE(lowest(m, s), -1e-3 * 0.05);
      const Energies e = test::energies_at(m, initial_controls(m), s);
      const double mechanical = e.kinetic + e.elastic + e.gravity;
      EXPECT_LE(mechanical, before + 1e-6 * weight(m)) << young << " step " << i;
      before = mechanical;
    }
    EXPECT_NEAR(lowest(m, s), 0.0, 1e-4 * 0.05);
    Vec3 total = Vec3::Zero();
    double speed = 0.0;
    for (const ContactForce& p : s.reactions.contacts) total += p.force;
    for (const Vec3& v : s.half_velocity) speed = std::max(speed, v.norm());
    EXPECT_LE(speed, 1e-3);
    EXPECT_NEAR(total.y(), weight(m), 1e-3 * weight(m));
    EXPECT_LE(std::hypot(total.x(), total.z()), 1e-3 * weight(m));
  }
}

// Acceleration of a box on a slope of the given tangent, mu = 0.5, over half a second, half a
// second after it was put there (while it settles, friction also works across the slope).
Vec3 acceleration_on_slope(double tangent) {
  Material material = soft(1e6);
  material.damping_ratio = 1.0;
  Model m = box_above_ground(material, 0.0, 0.5);
  const double angle = std::atan(tangent);
  m.start_gravity = 9.81 * Vec3(std::sin(angle), -std::cos(angle), 0.0);
  State s = initial_state(m);
  ImplicitStepper stepper(m);
  const auto mean_velocity = [&] {
    for (int i = 0; i < 30; ++i) stepper.step(frame, initial_controls(m), {}, s);
    Vec3 momentum = Vec3::Zero();
    for (std::size_t i = 0; i < m.mass.size(); ++i) momentum += m.mass[i] * s.half_velocity[i];
    return Vec3(momentum / (weight(m) / 9.81));
  };
  const Vec3 before = mean_velocity();
  return (mean_velocity() - before) / 0.5;
}

TEST(Constraints, ASlopeHoldsUpToTheFrictionAngle) {
  EXPECT_LE(acceleration_on_slope(0.98 * 0.5).norm(), 1e-5);
  for (const double tangent : {1.02 * 0.5, 0.7}) {
    const double angle = std::atan(tangent);
    const double slide = 9.81 * (std::sin(angle) - 0.5 * std::cos(angle));
    EXPECT_NEAR(acceleration_on_slope(tangent).x(), slide, 0.02 * slide) << tangent;
  }
}

TEST(Constraints, ASlidingBoxStopsWhereFrictionHasTakenItsEnergy) {
  Material material = soft(1e6);
  material.damping_ratio = 1.0;
  const Model m = box_above_ground(material, 0.0, 0.5, 1);
  State s = initial_state(m);
  const double speed = 1.0;
  for (Vec3& v : s.half_velocity) v = Vec3(speed, 0, 0);
  const double kinetic = 0.5 * weight(m) / 9.81 * speed * speed;
  ImplicitStepper stepper(m);
  for (int i = 0; i < 60; ++i) stepper.step(frame, initial_controls(m), {}, s);
  // v^2 / (2 mu g), less what a step of backward Euler is ahead of it: mu g h t / 2.
  const double stop = speed / (0.5 * 9.81);
  const double distance = 0.5 * speed * stop - 0.5 * speed * frame;
  EXPECT_NEAR(s.position[0].x() - m.rest_position[0].x(), distance, 0.05 * distance);
  for (const Vec3& v : s.half_velocity) EXPECT_LE(v.norm(), 1e-4);
  EXPECT_NEAR(s.energy.dissipated, kinetic, 0.05 * kinetic);
}

TEST(Constraints, ThePlasticImpactOfAMassIsAllDissipated) {
  Model m =
      point_masses({{Vec3(0, 0, 0), 1.0, Vec3(0, -3, 0)}, {Vec3(1, 0, 0), 1.0, Vec3(0, -3, 0)}});
  m.start_gravity = Vec3(0, -10, 0);
  stand_on_ground(m, Vec3(0, -0.5, 0), Vec3::UnitY(), 0.0, 0.5);
  finish(m);
  State s = initial_state(m);
  ImplicitStepper stepper(m);
  for (int i = 0; i < 60; ++i) stepper.step(0.005, initial_controls(m), {}, s);
  EXPECT_NEAR(s.position[0].y(), -0.5, 1e-6);
  EXPECT_LT(s.half_velocity[0].norm(), 1e-4 * 10.0 * 0.005);  // ground_tolerance / h
  // 9 J of motion and 10 J of height; backward Euler keeps part of the impact to itself.
  EXPECT_NEAR(s.energy.dissipated, 19.0, 0.5);
}

TEST(Constraints, StretchLimitsHoldUnderAHeavyLoadAtAnyStiffness) {
  for (const double young : {1e2, 1e5, 1e9}) {
    if (test::sanitized && young != 1e5) continue;
    Model m = tissue_box(soft(young), {2, 4, 2}, Vec3(0.05, 0.1, 0.05));
    std::fill(m.stretch_limit.begin(), m.stretch_limit.end(), 0.1);
    m.pins.push_back({"top", test::nodes_at(m, 1, 0.05), {}});
    m.loads.push_back({"pull", test::nodes_at(m, 1, -0.05), Vec3(0, -100, 0)});
    finish(m);
    State s = initial_state(m);
    ImplicitStepper stepper(m);
    for (int i = 0; i < 30; ++i) {
      EXPECT_TRUE(stepper.step(frame, initial_controls(m), {}, s).limits_met)
          << young << " step " << i;
      EXPECT_LE(measure_limit_violation(m, s.position), m.limit_tolerance);
    }
    State rest = initial_state(m);
    EXPECT_TRUE(StaticSolver(m).solve(initial_controls(m), 1.0, {}, rest).limits_met) << young;
    EXPECT_LE(measure_limit_violation(m, rest.position), m.limit_tolerance);
    // Stiff bodies never come to their limits.
    EXPECT_EQ(any_active(rest.reactions), young < 1e9);
  }
}

TEST(Constraints, VolumeLimitsHold) {
  for (const double poisson : {0.3, 0.45}) {
    Material material = soft(5e3, poisson);
    material.volume_limit = 1e-3;
    Model m = tissue_box(material, {2, 2, 4}, Vec3(0.1, 0.1, 0.2));
    m.pins.push_back({"wall", test::nodes_at(m, 2, -0.1), {}});
    finish(m);
    ASSERT_TRUE(m.has_volume_limit);
    State s = initial_state(m);
    ImplicitStepper stepper(m);
    for (int i = 0; i < (test::sanitized ? 2 : 30); ++i) {
      EXPECT_TRUE(stepper.step(frame, initial_controls(m), {}, s).limits_met);
      EXPECT_LE(largest_cell_change(m, s.position), 1e-3 + 1e-4);
    }
    State rest = initial_state(m);
    EXPECT_TRUE(StaticSolver(m).solve(initial_controls(m), 1.0, {}, rest).limits_met);
    EXPECT_LE(largest_cell_change(m, rest.position), 1e-3 + 1e-4);
    EXPECT_TRUE(any_active(rest.reactions));
  }
}

TEST(Constraints, ABoxRestsOnTheGroundWhereItIsPutDown) {
  const Model m = box_above_ground(soft(1e4), 0.03, 0.5);
  State s = initial_state(m);
  const StepReport report = StaticSolver(m).solve(initial_controls(m), 1.0, {}, s);
  EXPECT_TRUE(report.limits_met);
  EXPECT_EQ(report.contacts, 9);
  EXPECT_NEAR(lowest(m, s), 0.0, 1e-4 * 0.05);
  Vec3 total = Vec3::Zero(), shift = Vec3::Zero();
  for (const ContactForce& p : s.reactions.contacts) total += p.force;
  for (std::size_t i = 0; i < s.position.size(); ++i) {
    shift += m.mass[i] * (s.position[i] - m.rest_position[i]);
  }
  shift /= weight(m) / 9.81;
  EXPECT_LE((total - Vec3(0, weight(m), 0)).norm(), 1e-4 * weight(m));
  EXPECT_LE(std::hypot(shift.x(), shift.z()), 1e-5);
}

TEST(Constraints, FrictionHoldsABodyOnASlopeUpToItsAngle) {
  for (const double friction : {0.05, 0.5}) {  // the slope is 0.11
    Model m = box_above_ground(soft(), 0.0, friction);
    m.start_gravity = Vec3(1, -9, 0);
    State s = initial_state(m);
    if (friction < 0.11) {
      EXPECT_THROW(StaticSolver(m).solve(initial_controls(m), 1.0, {}, s), Error);
    } else {
      EXPECT_LE(StaticSolver(m).solve(initial_controls(m), 1.0, {}, s).residual, 1e-6);
      for (std::size_t i = 0; i < s.position.size(); ++i)
        EXPECT_LE((s.position[i] - m.rest_position[i]).norm(), 0.01);
    }
  }
}

TEST(Constraints, TangledBodiesAreLedBack) {
  for (const bool pinned : {false, true}) {
    for (const test::Tangle tangle : test::tangles) {
      if (test::sanitized && (!pinned || tangle != test::Tangle::inverted)) continue;
      Material material = soft(1e4);
      material.damping_ratio = 0.5;
      material.drag = 10.0;
      Model m = tissue_box(material, {3, 3, 3});
      m.start_gravity.setZero();
      if (pinned) m.pins.push_back({"wall", test::nodes_at(m, 0, -0.05), {}});
      finish(m);
      State s = initial_state(m);
      test::tangle_nodes(m, tangle, s.position);
      ImplicitStepper stepper(m);
      int righted = 0;
      for (int i = 0; i < 90; ++i)
        righted += stepper.step(frame, initial_controls(m), {}, s).recovered;
      EXPECT_GT(righted, 0);
      EXPECT_LT(righted, 20);
      const std::vector<Vec3> shape = rest_shape_at(m, m.bodies[0], s.position);
      double error = 0.0;
      for (std::size_t i = 0; i < shape.size(); ++i) {
        error = std::max(error, (s.position[i] - shape[i]).norm());
      }
      EXPECT_LE(error, 1e-3) << pinned << " " << static_cast<int>(tangle);
    }
  }
}

// A box on the ground that its limits hold up too.
Model limited_box(int cells) {
  Material material = soft(1e4);
  material.volume_limit = 0.002;
  Model m = tissue_box(material, {cells, cells, cells});
  std::fill(m.stretch_limit.begin(), m.stretch_limit.end(), 0.01);
  stand_on_ground(m, Vec3(0, -0.05, 0), Vec3::UnitY(), 0.0, 0.5);
  finish(m);
  return m;
}

TEST(Constraints, SameBitsAtAnyThreadCount) {
  const Model m = limited_box(test::sanitized ? 4 : 8);  // 8: several blocks of tets and springs
  const ImplicitOptions options{.scheme = Scheme::backward_euler, .tolerance = 1e-2};
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    State s = initial_state(m);
    ImplicitStepper(m).step(0.25 * frame, initial_controls(m), options, s);
    EXPECT_TRUE(any_active(s.reactions));
    hashes.push_back(s.hash());
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(Constraints, TheStateIsAllThatAStepGoesOnFrom) {
  const Model m = limited_box(2);
  State through = initial_state(m);
  State restarted = through;
  ImplicitStepper stepper(m);
  for (int i = 0; i < 5; ++i) {
    stepper.step(frame, initial_controls(m), {}, through);
    ImplicitStepper(m).step(frame, initial_controls(m), {}, restarted);
  }
  EXPECT_TRUE(any_active(through.reactions));
  EXPECT_EQ(through.hash(), restarted.hash());
}

}  // namespace
}  // namespace sinew
