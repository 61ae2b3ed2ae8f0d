#include "sinew/solver/stable_step.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sinew/base/error.h"
#include "sinew/solver/verlet.h"
#include "tests/support/effort.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

using test::oscillator;
using test::point_masses;
using test::tissue_box;

TEST(StableStep, UndampedOscillatorByHand) {
  const Model m = oscillator(0.0, 1.0);
  ForceEvaluator forces(m, Precision::double_);
  const StableStep s = find_stable_step(m, initial_controls(m), m.rest_position, forces);
  EXPECT_NEAR(s.step, 2.0 / 5.0, 1e-10);
  EXPECT_NEAR(s.omega_max, 5.0, 1e-10);
  EXPECT_EQ(s.zeta, 0.0);
}

TEST(StableStep, DampedOscillatorFollowsTheFormula) {
  for (const double zeta : {0.1, 0.5, 1.0, 3.0}) {
    const Model m = oscillator(2 * zeta * std::sqrt(50.0 * 2.0), 1.0);
    ForceEvaluator forces(m, Precision::double_);
    const StableStep s = find_stable_step(m, initial_controls(m), m.rest_position, forces);
    EXPECT_NEAR(s.step, 2.0 / 5.0 * (std::sqrt(1 + zeta * zeta) - zeta), 1e-3 * s.step) << zeta;
    EXPECT_NEAR(s.zeta, zeta, 1e-9);
  }
}

TEST(StableStep, NothingThatMovesHasNoLimit) {
  Model m = point_masses({{Vec3(0, 0, 0), 1.0}});
  finish(m);
  ForceEvaluator forces(m, Precision::double_);
  EXPECT_TRUE(std::isinf(find_stable_step(m, initial_controls(m), m.rest_position, forces).step));
}

// Whether the linear motion about rest stays small for many steps of length h.
bool stays_bounded(const Model& m, double h) {
  State s = initial_state(m);
  for (std::size_t i = 0; i < s.position.size(); ++i) {
    if (m.inverse_mass[i] == 0.0) continue;
    const double sign = (i * 2654435761u >> 7) % 2 == 0 ? 1.0 : -1.0;
    s.position[i] += sign * 1e-9 * Vec3(1.0, -0.7, 0.4);
  }
  VerletStepper stepper(m, Precision::double_);
  for (int i = 0; i < 3000; ++i) {
    try {
      stepper.step(h, initial_controls(m), s);
    } catch (const Error&) {
      return false;
    }
  }
  double distance = 0.0;
  for (std::size_t i = 0; i < s.position.size(); ++i) {
    distance = std::max(distance, (s.position[i] - m.rest_position[i]).norm());
  }
  return distance < 1e-6;
}

TEST(StableStep, IsSharpOnTissueWithAndWithoutDamping) {
  for (const double zeta : {0.0, 0.1, 1.0}) {
    if (test::sanitized && zeta != 0.1) continue;
    Model m = tissue_box({.law = Law::lloyd, .young = 1e4, .damping_ratio = zeta}, {3, 3, 3});
    m.start_gravity = Vec3::Zero();
    m.pins = {{"top", test::nodes_at(m, 1, 0.05), {}}};
    finish(m);
    ForceEvaluator forces(m, Precision::double_);
    const double h = find_stable_step(m, initial_controls(m), m.rest_position, forces).step;
    EXPECT_TRUE(stays_bounded(m, 0.97 * h)) << zeta;
    EXPECT_FALSE(stays_bounded(m, 1.05 * h)) << zeta;
  }
}

TEST(StableStep, IsSharpOnViscousTissue) {
  if (test::sanitized) return;  // thousands of steps of what the test above runs, too
  for (const double zeta : {0.05, 0.2, 1.0}) {
    Model m = tissue_box({.damping = Damping::material, .damping_ratio = zeta}, {3, 3, 3});
    m.start_gravity = Vec3::Zero();
    m.pins = {{"top", test::nodes_at(m, 1, 0.05), {}}};
    finish(m);
    ForceEvaluator forces(m, Precision::double_);
    const double h = find_stable_step(m, initial_controls(m), m.rest_position, forces).step;
    EXPECT_TRUE(stays_bounded(m, 0.97 * h)) << zeta;
    EXPECT_FALSE(stays_bounded(m, 1.05 * h)) << zeta;
  }
}

TEST(StableStep, WatchingFromTheKnownModeFindsTheSameStep) {
  for (const double zeta : {0.0, 0.2}) {
    Model m = tissue_box({.law = Law::lloyd, .young = 1e4, .damping_ratio = zeta}, {4, 4, 4});
    finish(m);
    ForceEvaluator forces(m, Precision::double_);
    StableStep found = find_stable_step(m, initial_controls(m), m.rest_position, forces);
    const double watched = watch_stable_step(m, initial_controls(m), m.rest_position,
                                             0.9 * found.step, found.mode, forces);
    EXPECT_LT(watched, 1.01 * found.step);
    EXPECT_GT(watched, 0.95 * found.step);
  }
}

TEST(StableStep, StretchStiffensAndIsSeenAfterAFewLooks) {
  Model m = tissue_box({.law = Law::lloyd, .young = 1e4, .damping_ratio = 0.0}, {4, 4, 4});
  finish(m);
  ForceEvaluator forces(m, Precision::double_);
  StableStep rest = find_stable_step(m, initial_controls(m), m.rest_position, forces);
  std::vector<Vec3> stretched = m.rest_position;
  for (Vec3& p : stretched) p *= 3.0;
  double h = rest.step;
  for (int n = 0; n < 5; ++n)
    h = watch_stable_step(m, initial_controls(m), stretched, h, rest.mode, forces);
  EXPECT_LT(h, 0.95 * rest.step);
  EXPECT_NEAR(h, find_stable_step(m, initial_controls(m), stretched, forces).step, 0.02 * h);
}

TEST(StableStep, DescribesTheStiffestSpring) {
  const Model m = oscillator(3.0, 1.0);
  EXPECT_EQ(describe_spring(m, 0),
            "spring 0 (body points, node 0 to body points, node 1): k = 50 N/m, l0 = 1 m, "
            "c = 3 N s/m");
}

}  // namespace
}  // namespace sinew
