#include "sinew/solver/verlet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sinew/base/error.h"
#include "sinew/base/parallel.h"
#include "sinew/forces/inversion_recovery.h"
#include "sinew/forces/loads.h"
#include "sinew/forces/obstacles.h"
#include "sinew/forces/strain_limits.h"
#include "sinew/forces/terms.h"
#include "sinew/solver/stable_step.h"
#include "tests/support/effort.h"
#include "tests/support/forces.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

using test::oscillator;
using test::point_masses;
using test::tissue_box;

State run(const Model& m, double h, int steps) {
  State s = initial_state(m);
  VerletStepper stepper(m, Precision::double_);
  for (int i = 0; i < steps; ++i) stepper.step(h, initial_controls(m), s);
  return s;
}

TEST(Verlet, OneSpringOscillatesAtSqrtKOverMWithSecondOrderError) {
  const Model m = oscillator();
  const double t = 2.0;
  const double exact = 1.0 + 0.1 * std::cos(5.0 * t);
  std::vector<double> errors;
  for (const int steps : {100, 200, 400, 800}) {
    errors.push_back(std::abs(run(m, t / steps, steps).position[1].x() - exact));
  }
  for (std::size_t i = 0; i + 1 < errors.size(); ++i) {
    EXPECT_NEAR(std::log2(errors[i] / errors[i + 1]), 2.0, 0.05) << "refinement " << i;
  }
  // The phase runs ahead by omega^3 h^2 t / 24.
  const double phase = 125.0 * (t / 800) * (t / 800) * t / 24;
  EXPECT_NEAR(errors.back(), 0.1 * phase * std::abs(std::sin(5.0 * t)), 0.02 * errors.back());
}

TEST(Verlet, StartsAsPositionVerletDoes) {
  // x(-h) = x0 - h v0 + a0 h^2/2, x(h) = 2 x0 - x(-h) + a0 h^2 = x0 + h v0 + a0 h^2/2.
  Model m = point_masses({{Vec3(0, 0, 0), 1.0, Vec3(3, 0, 0)}});
  m.start_gravity = Vec3(0, -10, 0);
  finish(m);
  const State s = run(m, 0.1, 1);
  EXPECT_NEAR(s.position[0].x(), 0.3, 1e-15);
  EXPECT_NEAR(s.position[0].y(), -0.05, 1e-15);
}

TEST(Verlet, MatchesPositionVerletStepByStep) {
  const Model m = oscillator();
  const double h = 0.01;
  double before = 0.1 + (-2.5) * h * h / 2, now = 0.1;  // extension; a = -25 * extension
  State s = initial_state(m);
  VerletStepper stepper(m, Precision::double_);
  for (int i = 0; i < 500; ++i) {
    const double next = 2 * now - before - 25.0 * now * h * h;
    before = now;
    now = next;
    stepper.step(h, initial_controls(m), s);
    ASSERT_NEAR(s.position[1].x() - 1.0, now, 1e-12);
  }
}

TEST(Verlet, TalksVelocityIsTheCentralDifference) {
  const Model m = oscillator();
  const double h = 0.01;
  State s = initial_state(m);
  VerletStepper stepper(m, Precision::double_);
  Vec3 before, at;
  for (int i = 0; i < 50; ++i) {
    before = s.position[1];
    stepper.step(h, initial_controls(m), s);
  }
  at = s.position[1];
  const std::vector<Vec3> force = test::forces_at(m, initial_controls(m), s).force;
  const Vec3 v = synchronous_velocity(m, s, force)[1];
  stepper.step(h, initial_controls(m), s);
  EXPECT_NEAR(v.x(), (s.position[1].x() - before.x()) / (2 * h), 1e-13);
  EXPECT_NE(at.x(), before.x());
}

TEST(Verlet, ParabolaOfAThrowIsExactWithAnyStepLengths) {
  Model m = point_masses({{Vec3(0, 0, 0), 1.0, Vec3(1, 5, 0)}});
  m.start_gravity = Vec3(0, -9.81, 0);
  finish(m);
  State s = initial_state(m);
  VerletStepper stepper(m, Precision::double_);
  for (const double h : {0.01, 0.01, 0.003, 0.02, 0.007, 0.01})
    stepper.step(h, initial_controls(m), s);
  const double t = s.time;
  const std::vector<Vec3> force = test::forces_at(m, initial_controls(m), s).force;
  EXPECT_NEAR(synchronous_velocity(m, s, force)[0].y(), 5 - 9.81 * t, 1e-13);
  EXPECT_NEAR(s.position[0].y(), 5 * t - 9.81 / 2 * t * t, 1e-14);
}

TEST(Verlet, DashpotDecaysAsTheDampedOscillator) {
  // c = 2 zeta sqrt(k m), zeta = 0.1: x = e^(-zeta w t) (cos wd t + zeta w/wd sin wd t).
  const double zeta = 0.1, omega = 5.0, t = 2.0;
  const Model m = oscillator(2 * zeta * std::sqrt(50.0 * 2.0));
  const double wd = omega * std::sqrt(1 - zeta * zeta);
  const double exact =
      0.1 * std::exp(-zeta * omega * t) * (std::cos(wd * t) + zeta * omega / wd * std::sin(wd * t));
  double last = 0.0;
  for (const int steps : {1000, 2000, 4000}) {
    const double error = std::abs(run(m, t / steps, steps).position[1].x() - 1.0 - exact);
    if (last > 0) {
      EXPECT_GT(last / error, 1.8);  // the lagged velocity makes it first order
    }
    last = error;
  }
  EXPECT_LT(last, 3e-5);
}

TEST(Verlet, DragDecaysExponentially) {
  Model m = point_masses({{Vec3(0, 0, 0), 1.0, Vec3(1, 0, 0)}});
  m.drag[0] = 0.5;
  finish(m);
  EXPECT_NEAR(run(m, 1e-4, 20'000).half_velocity[0].x(), std::exp(-1.0), 1e-4);
}

TEST(Verlet, DashpotHeatIsTheEnergyLost) {
  const Model m = oscillator(2.0);
  State s = initial_state(m);
  VerletStepper stepper(m, Precision::double_);
  const double start = test::energies_at(m, initial_controls(m), s).total();
  for (int i = 0; i < 20'000; ++i) stepper.step(1e-3, initial_controls(m), s);
  const Energies e = test::energies_at(m, initial_controls(m), s);
  EXPECT_NEAR(e.dissipated, start, 2e-3 * start);
  EXPECT_LT(e.kinetic + e.elastic, 1e-3 * start);
}

Vec3 momentum(const Model& m, const State& s) {
  Vec3 p = Vec3::Zero();
  for (std::size_t i = 0; i < m.mass.size(); ++i) p += m.mass[i] * s.half_velocity[i];
  return p;
}

// About the origin, with w and the mean of the positions that w connects: x - h w / 2.
Vec3 angular_momentum(const Model& m, const State& s) {
  Vec3 l = Vec3::Zero();
  for (std::size_t i = 0; i < m.mass.size(); ++i) {
    l += m.mass[i] *
         (s.position[i] - 0.5 * s.last_step * s.half_velocity[i]).cross(s.half_velocity[i]);
  }
  return l;
}

TEST(Verlet, FreeFlightKeepsMomentumAndAngularMomentumToRounding) {
  BodySpec spec;
  spec.name = "box";
  spec.mesh = box(Vec3(0.1, 0.2, 0.3), {2, 3, 4});
  spec.materials = {{.law = Law::lloyd, .young = 2e4, .damping_ratio = 0.2}};
  spec.regions = {"all"};
  spec.velocity = Vec3(0.3, -0.2, 0.5);
  spec.spin = Vec3(3, 1, -2);
  Model m;
  m.start_gravity = Vec3::Zero();
  add_body(m, spec);
  finish(m);
  VerletStepper stepper(m, Precision::double_);
  State s = initial_state(m);
  const double h =
      0.5 * find_stable_step(m, initial_controls(m), s.position, stepper.forces()).step;
  stepper.step(h, initial_controls(m), s);
  const Vec3 p = momentum(m, s), l = angular_momentum(m, s);
  for (int i = 0; i < 2000; ++i) stepper.step(h, initial_controls(m), s);
  EXPECT_LT((momentum(m, s) - p).norm(), 1e-13 * p.norm() * 10);
  EXPECT_LT((angular_momentum(m, s) - l).norm(), 1e-12 * l.norm());
  // It has really deformed and turned.
  EXPECT_GT((s.position[0] - m.rest_position[0]).norm(), 0.05);
}

TEST(Verlet, EnergyStaysBoundedWithoutDampingOver100000Steps) {
  Model m = tissue_box({.law = Law::lloyd, .young = 1e4, .damping_ratio = 0.0}, {2, 2, 2});
  m.pins = {{"floor", test::nodes_at(m, 1, -0.05), {}}};
  finish(m);
  VerletStepper stepper(m, Precision::double_);
  State s = initial_state(m);
  for (std::size_t i = 0; i < s.position.size(); ++i) {
    if (m.inverse_mass[i] > 0) s.position[i] *= 1.05;  // rings in many modes
  }
  const double h =
      0.5 * find_stable_step(m, initial_controls(m), s.position, stepper.forces()).step;
  const double start = test::energies_at(m, initial_controls(m), s).total();
  double worst_early = 0.0, worst_late = 0.0;
  const int steps = test::effort(100'000);
  for (int i = 1; i <= steps; ++i) {
    stepper.step(h, initial_controls(m), s);
    if (i % 100 != 0) continue;
    const double error =
        std::abs(test::energies_at(m, initial_controls(m), s).total() - start) / start;
    double& worst = i <= steps / 10 ? worst_early : worst_late;
    worst = std::max(worst, error);
  }
  EXPECT_LT(worst_early, 0.2);
  EXPECT_LT(worst_late, 1.5 * worst_early);  // no drift
}

TEST(Verlet, LimitsHoldToTheirToleranceAtTheEndOfAStep) {
  Material material{.law = Law::lloyd, .young = 500.0};
  material.stretch_limit = 0.1;
  material.compress_limit = 0.1;
  Model m = tissue_box(material, {3, 3, 3});
  m.pins = {{"top", test::nodes_at(m, 1, 0.05), {}}};
  m.limit_sweeps = 500;
  m.limit_tolerance = 1e-3;
  finish(m);
  VerletStepper stepper(m, Precision::double_);
  State s = initial_state(m);
  const double h =
      0.5 * find_stable_step(m, initial_controls(m), s.position, stepper.forces()).step;
  int sweeps = 0;
  for (int i = 0; i < 600; ++i) {
    const StepReport r = stepper.step(h, initial_controls(m), s);
    ASSERT_TRUE(r.limits_met);
    ASSERT_LE(measure_limit_violation(m, s.position), 1e-3);
    sweeps += r.limit_sweeps;
  }
  EXPECT_GT(sweeps, 100);  // the limits were at work
}

TEST(Verlet, LimitsReportWhenTheSweepsDidNotDo) {
  Model m = point_masses({{Vec3(0, 0, 0), 0.0}, {Vec3(1, 0, 0), 1.0}, {Vec3(2.5, 0, 0), 0.0}});
  test::add_limited(m, 0, 1, 1.0, 1.0, 0.1, 0.1);
  test::add_limited(m, 1, 2, 1.0, 1.0, 0.1, 0.1);  // 2.5 m apart: cannot both hold
  m.limit_sweeps = 5;
  finish(m);
  State s = initial_state(m);
  VerletStepper stepper(m, Precision::double_);
  const StepReport r = stepper.step(1e-3, initial_controls(m), s);
  EXPECT_FALSE(r.limits_met);
  EXPECT_EQ(r.limit_sweeps, 5);
}

TEST(Verlet, PinsFollowTheirPathsAndTheirWorkIsCounted) {
  // Pull the far end of a spring chain slowly: the work goes into the spring.
  Model m = point_masses({{Vec3(0, 0, 0), 0.0}, {Vec3(1, 0, 0), 0.1}, {Vec3(2, 0, 0), 1.0}});
  m.pins[0].nodes = {0};
  Path path;
  path.keys = {{1.0, Vec3(0.5, 0, 0), Vec3::Zero()}};
  path.smooth = true;
  m.pins.push_back({"hand", {2}, path});
  add_attachment(m, 0, 1, 100.0, 1.0, 1.0);
  add_attachment(m, 1, 2, 100.0, 1.0, 1.0);
  finish(m);
  const State s = run(m, 1e-4, 20'000);
  EXPECT_NEAR(s.position[2].x(), 2.5, 1e-15);
  EXPECT_NEAR(s.position[1].x(), 1.25, 1e-6);
  const Energies e = test::energies_at(m, initial_controls(m), s);
  EXPECT_NEAR(e.elastic, 2 * 0.5 * 100 * 0.25 * 0.25, 1e-4);
  EXPECT_NEAR(e.work_in, e.elastic + e.dissipated, 1e-3 * e.work_in);
}

TEST(Verlet, LoadsActWhileTheyLastAndTheirWorkIsCounted) {
  Model m = point_masses({{Vec3(0, 0, 0), 2.0}, {Vec3(1, 0, 0), 2.0}});
  m.loads = {{"push", {0, 1}, Vec3(8, 0, 0), 0.0, 0.5, 0.0}};
  finish(m);
  const State s = run(m, 1e-3, 1000);
  // 4 N on 2 kg for 0.5 s: 1 m/s each, 2 J in all.
  EXPECT_NEAR(s.half_velocity[0].x(), 1.0, 2e-3);
  EXPECT_NEAR(test::energies_at(m, initial_controls(m), s).kinetic, s.energy.work_in, 1e-12);
}

TEST(Verlet, AMovingObstaclePressesAndItsWorkIsCounted) {
  Model m = tissue_box({.law = Law::lloyd, .young = 1e4, .damping_ratio = 0.5}, {4, 4, 4});
  m.start_gravity = Vec3::Zero();
  m.pins = {{"floor", test::nodes_at(m, 1, -0.05), {}}};
  Path path;
  path.keys = {{0.2, Vec3(0, -0.02, 0), Vec3::Zero()}};
  path.smooth = true;
  add_obstacle(m, test::soft_sphere("ball", Vec3(0.01, 0.09, 0), 0.04, 2e8, path));
  finish(m);
  VerletStepper stepper(m, Precision::double_);
  State s = initial_state(m);
  const double h =
      0.5 * find_stable_step(m, initial_controls(m), s.position, stepper.forces()).step;
  while (s.time < 0.6) stepper.step(h, initial_controls(m), s);
  const ObstacleReading ball = read_obstacles(configuration(m, initial_controls(m), s))[0];
  EXPECT_GT(ball.contacts, 3);
  EXPECT_GT(ball.force.y(), 1.0);
  EXPECT_LT(ball.depth, 2e-4);  // of 20 mm
  const Energies e = test::energies_at(m, initial_controls(m), s);
  EXPECT_GT(e.work_in, 0.0);
  EXPECT_LT(e.kinetic, 1e-2 * e.work_in);
  EXPECT_LT(std::abs(e.total()), 0.01 * e.work_in);
}

TEST(Verlet, AnElasticImpactOnAnObstacleKeepsTheEnergy) {
  Model m = tissue_box({.law = Law::lloyd, .young = 1e4, .damping_ratio = 0.0}, {3, 3, 3});
  m.start_gravity = Vec3::Zero();
  for (Vec3& v : m.start_velocity) v = Vec3(0, -0.5, 0);
  add_obstacle(m, test::soft_sphere("ball", Vec3(0.01, -0.1, 0), 0.04, 2e8));
  finish(m);
  VerletStepper stepper(m, Precision::double_);
  State s = initial_state(m);
  const double start = test::energies_at(m, initial_controls(m), s).total();
  const double h =
      0.3 * find_stable_step(m, initial_controls(m), s.position, stepper.forces()).step;
  double deepest = 0.0;
  while (s.time < 0.3) {
    stepper.step(h, initial_controls(m), s);
    deepest = std::max(deepest, test::energies_at(m, initial_controls(m), s).contact);
  }
  EXPECT_GT(deepest, 1e-3 * start);
  EXPECT_EQ(read_obstacles(configuration(m, initial_controls(m), s))[0].contacts, 0);
  EXPECT_GT(momentum(m, s).y(), 0.0);  // it came back
  EXPECT_NEAR(test::energies_at(m, initial_controls(m), s).total(), start, 0.02 * start);
}

TEST(Verlet, LoadsRampUp) {
  const Load load{"push", {0}, Vec3(1, 0, 0), 1.0, 3.0, 0.5};
  EXPECT_EQ(load_share(load, 0.99), 0.0);
  EXPECT_EQ(load_share(load, 1.25), 0.5);
  EXPECT_EQ(load_share(load, 2.0), 1.0);
  EXPECT_EQ(load_share(load, 3.01), 0.0);
}

TEST(Verlet, ANonFiniteStateStopsAtThatStepAndNamesThePlace) {
  Model m = tissue_box({.law = Law::lloyd, .young = 1e6}, {2, 2, 2});
  m.pins = {{"floor", test::nodes_at(m, 1, -0.05), {}}};
  finish(m);
  try {
    run(m, 1.0, 1000);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::diverged);
    EXPECT_NE(e.message().find("the state has run away beyond 1e9 m at t = "), std::string::npos);
    EXPECT_NE(e.message().find("body box, node "), std::string::npos);
    EXPECT_NE(e.message().find("its spring "), std::string::npos);
  }
}

// The law itself leads a free body back from flat and inside out; inversion recovery does from
// everywhere.
TEST(Verlet, FindsBackFromTangledStarts) {
  for (const bool pinned : {false, true}) {
    for (const test::Tangle tangle : test::tangles) {
      if (test::sanitized && (!pinned || tangle != test::Tangle::random)) continue;
      Material material;
      material.young = 1e4;
      material.damping_ratio = 0.3;
      Model m = tissue_box(material, {3, 3, 3});
      m.start_gravity = Vec3::Zero();
      if (pinned) m.pins.push_back({"floor", test::nodes_at(m, 1, -0.05), {}});
      finish(m);
      State state = initial_state(m);
      test::tangle_nodes(m, tangle, state.position);
      VerletStepper stepper(m, Precision::double_);
      int righted = 0;
      for (int i = 0; i < 4000; ++i)
        righted += stepper.step(2e-4, initial_controls(m), state).recovered;
      EXPECT_GT(righted, 0);
      EXPECT_LT(righted, 2000);
      const std::vector<Vec3> shape = rest_shape_at(m, m.bodies[0], state.position);
      for (std::size_t i = 0; i < shape.size(); ++i) {
        EXPECT_LE((state.position[i] - shape[i]).norm(), 1e-3) << "node " << i;
      }
    }
  }
}

TEST(Verlet, SameBitsAtAnyThreadCount) {
  Model m = tissue_box({.law = Law::lloyd, .young = 1e4}, {10, 10, 10});
  m.pins = {{"top", test::nodes_at(m, 1, 0.05), {}}};
  finish(m);
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 2, 3}) {
    const ThreadLimit limit(threads);
    hashes.push_back(run(m, 1e-4, 100).hash());
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
}

}  // namespace
}  // namespace sinew
