// Implicit steps that run out of time.
#include "sinew/solver/deadline.h"

#include <gtest/gtest.h>

#include "sinew/forces/terms.h"
#include "sinew/solver/implicit.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

double kinetic(const Model& m, const Field& v) {
  double sum = 0.0;
  for (std::size_t i = 0; i < v.size(); ++i) sum += 0.5 * m.mass[i] * v[i].squaredNorm();
  return sum;
}

double potential(const Model& m, const State& s) {
  const Controls controls = initial_controls(m);
  return potential_energy(configuration(m, controls, s), volumes_of_tets(m, s.position));
}

// What stability rests on: with one product a step, |v - v_n|^2 m/2 + E(x) still ends at or below
// its value of standing still, |v_n|^2 m/2 + E(x_n).
TEST(Deadline, AStepCutShortLowersThePotential) {
  Material material;
  material.young = 1e5;
  Model m = test::tissue_box(material, {3, 3, 3});
  finish(m);
  State s = initial_state(m);
  for (std::size_t i = 0; i < s.position.size(); ++i) {  // stretched, twisted and thrown
    const Vec3 X = s.position[i];
    s.position[i] = Vec3(1.5 * X.x(), X.y() - 4.0 * X.x() * X.z(), X.z() + 4.0 * X.x() * X.y());
    s.half_velocity[i] = Vec3(0, 1, 20.0 * X.x());
  }
  ImplicitStepper stepper(m);
  ImplicitOptions options;
  options.scheme = Scheme::backward_euler;
  options.deadline = Clock::now();
  for (int step = 0; step < 100; ++step) {
    const State before = s;
    const StepReport report = stepper.step(1.0 / 60.0, initial_controls(m), options, s);
    EXPECT_EQ(report.newton, 1);
    EXPECT_EQ(report.products, 1);
    EXPECT_EQ(report.cuts, 0);
    EXPECT_TRUE(report.ran_out);
    EXPECT_GT(report.residual, options.tolerance);
    Field change(s.half_velocity);
    add(change, -1.0, before.half_velocity);
    const double start_value = kinetic(m, before.half_velocity) + potential(m, before);
    EXPECT_LE(kinetic(m, change) + potential(m, s), start_value + 1e-12 * std::abs(start_value))
        << step;
  }
}

TEST(Deadline, AFarOneChangesNothing) {
  Model m = test::tissue_box({}, {2, 2, 2});
  finish(m);
  ImplicitOptions options;
  State a = initial_state(m), b = a;
  ImplicitStepper(m).step(0.01, initial_controls(m), options, a);
  options.deadline = Clock::now() + std::chrono::hours(1);
  const StepReport report = ImplicitStepper(m).step(0.01, initial_controls(m), options, b);
  EXPECT_FALSE(report.ran_out);
  EXPECT_EQ(a.hash(), b.hash());
}

}  // namespace
}  // namespace sinew
