// Distances between nodes (forces/assemble.h, add_distance) in every stepper.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sinew/forces/terms.h"
#include "sinew/solver/implicit.h"
#include "sinew/solver/static.h"
#include "sinew/solver/verlet.h"
#include "tests/support/forces.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

using test::point_masses;

constexpr double start_angle = 0.3;  // [rad]

// 1 kg on a rod of 2 m, released at start_angle from straight down.
Model pendulum() {
  Model m = point_masses(
      {{Vec3::Zero(), 0.0}, {2.0 * Vec3(std::sin(start_angle), -std::cos(start_angle), 0), 1.0}});
  m.start_gravity = Vec3(0, -9.81, 0);
  add_distance(m, 0, 1, 2.0, false);
  m.limit_sweeps = 20;
  finish(m);
  return m;
}

// 2 pi sqrt(l/g) (1 + a^2/16 + 11 a^4/3072) [s]
double exact_period() {
  const double a2 = start_angle * start_angle;
  return 2.0 * std::numbers::pi * std::sqrt(2.0 / 9.81) * (1.0 + a2 / 16.0 + 11.0 * a2 * a2 / 3072);
}

// Time between the first two passes through the vertical in the same direction [s].
template <typename Step>
double measured_period(double h, const Model& m, State& s, const Step& step) {
  std::vector<double> passes;
  while (passes.size() < 2 && s.time < 10.0) {
    const double before = s.position[1].x();
    step(s);
    EXPECT_NEAR(s.position[1].norm(), 2.0, 2.0 * m.limit_tolerance);
    const double after = s.position[1].x();
    if (before > 0.0 && after <= 0.0) passes.push_back(s.time - h * after / (after - before));
  }
  return passes.size() < 2 ? 0.0 : passes[1] - passes[0];
}

TEST(Distances, APendulumOfVerletHasItsPeriodAndKeepsItsEnergy) {
  const Model m = pendulum();
  State s = initial_state(m);
  VerletStepper verlet(m, Precision::double_);
  const double energy = test::energies_at(m, initial_controls(m), s).total();
  const double h = 0.005;
  const double period = measured_period(h, m, s, [&](State& state) {
    verlet.step(h, initial_controls(m), state);
    ASSERT_NEAR(state.position[1].norm(), 2.0, 1e-14);
  });
  EXPECT_NEAR(period, exact_period(), 0.001 * period);
  const double swing = 9.81 * 2.0 * (1.0 - std::cos(start_angle));
  EXPECT_NEAR(test::energies_at(m, initial_controls(m), s).total(), energy, 0.01 * swing);
  // Projecting after the move takes energy, first order in the step.
  EXPECT_NEAR(s.energy.dissipated, 0.0, 0.1 * swing);
}

TEST(Distances, APendulumOfImplicitStepsHasItsPeriod) {
  const Model m = pendulum();
  State s = initial_state(m);
  ImplicitStepper stepper(m);
  const double h = 0.01;
  const double period = measured_period(
      h, m, s, [&](State& state) { stepper.step(h, initial_controls(m), {}, state); });
  EXPECT_NEAR(period, exact_period(), 0.01 * period);
}

// Masses of 1 to 5 kg on a chain that flies freely, one end of it fast.
TEST(Distances, AChainKeepsItsMomentumAndAngularMomentum) {
  std::vector<test::Point> points;
  for (int i = 0; i < 5; ++i) {
    points.push_back({Vec3(0.5 * i, 0, 0), 1.0 + i, i == 4 ? Vec3(0, 3, 1) : Vec3(0, 0, 0)});
  }
  Model m = point_masses(points);
  for (Index i = 0; i < 4; ++i) add_distance(m, i, i + 1, 0.5, false);
  m.limit_sweeps = 500;
  m.limit_tolerance = 1e-6;
  finish(m);
  State s = initial_state(m);
  VerletStepper verlet(m, Precision::double_);
  const auto momenta = [&] {
    Vec3 linear = Vec3::Zero();
    Vec3 angular = Vec3::Zero();
    for (std::size_t i = 0; i < s.position.size(); ++i) {
      linear += m.mass[i] * s.half_velocity[i];
      // The half-step velocity belongs to the middle of the way.
      const Vec3 middle = s.position[i] - 0.5 * s.last_step * s.half_velocity[i];
      angular += m.mass[i] * middle.cross(s.half_velocity[i]);
    }
    return std::pair(linear, angular);
  };
  verlet.step(1e-3, initial_controls(m), s);
  const auto before = momenta();
  for (int i = 0; i < 2000; ++i) ASSERT_TRUE(verlet.step(1e-3, initial_controls(m), s).limits_met);
  const auto after = momenta();
  EXPECT_LT((after.first - before.first).norm(), 1e-11 * before.first.norm());
  // The projection turns with the rods within a step: first order in the step.
  EXPECT_LT((after.second - before.second).norm(), 1e-2 * before.second.norm());
}

// 1 kg and below it 3 kg, on ropes from two walls: rest and reactions by hand.
TEST(Distances, ARestStateHangsOnItsRopes) {
  Model m = point_masses({{Vec3(-3, 0, 0), 0.0}, {Vec3(3, 0, 0), 0.0}, {Vec3(0, -1, 0), 1.0}});
  m.start_gravity = Vec3(0, -9.81, 0);
  add_attachment(m, 0, 2, 1e-3, 0.0, 1.0);  // weak: holds the guess in place
  add_distance(m, 0, 2, 5.0, true);
  add_distance(m, 1, 2, 5.0, false);
  finish(m);
  State s = initial_state(m);
  StaticSolver solver(m);
  const StepReport report = solver.solve(initial_controls(m), 0.0, {}, s);
  EXPECT_TRUE(report.limits_met);
  EXPECT_NEAR(s.position[2].x(), 0.0, 0.01);
  EXPECT_NEAR(s.position[2].y(), -4.0, 0.01);
}

// Bodies of tissue tied by a distance between their nearest nodes: the energy account stays closed.
TEST(Distances, BodiesOnADistanceSwingWithoutGainingEnergy) {
  Material material;
  material.young = 2e4;
  Model m;
  for (int b = 0; b < 2; ++b) {
    BodySpec spec;
    spec.name = b == 0 ? "upper" : "lower";
    spec.mesh = box(Vec3(0.1, 0.1, 0.1), {2, 2, 2});
    for (Vec3& x : spec.mesh.nodes) x += Vec3(0.15 * b, -0.2 * b, 0);
    spec.materials = {material};
    spec.regions = {"all"};
    add_body(m, spec);
  }
  m.pins.push_back({"top", test::nodes_at(m, 1, 0.05), {}});
  const Index from = test::nodes_at(m, 1, -0.05).front();
  const Index to = test::nodes_at(m, 1, -0.15).front();
  const double length = (m.rest_position[uz(from)] - m.rest_position[uz(to)]).norm();
  add_distance(m, from, to, length, false);
  m.limit_sweeps = 20;
  finish(m);
  State s = initial_state(m);
  VerletStepper verlet(m, Precision::double_);
  const double start = test::energies_at(m, initial_controls(m), s).total();
  for (int i = 0; i < 4000; ++i) {
    verlet.step(2e-4, initial_controls(m), s);
    ASSERT_NEAR((s.position[uz(from)] - s.position[uz(to)]).norm(), length, 1e-13);
  }
  const Energies e = test::energies_at(m, initial_controls(m), s);
  EXPECT_NEAR(e.total(), start, 0.01 * std::abs(e.gravity));
}

}  // namespace
}  // namespace sinew
