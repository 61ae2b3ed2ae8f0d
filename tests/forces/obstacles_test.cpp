#include "sinew/forces/obstacles.h"

#include <gtest/gtest.h>

#include "sinew/base/random.h"
#include "sinew/forces/stiffness.h"
#include "sinew/forces/terms.h"
#include "tests/support/forces.h"
#include "tests/support/models.h"
#include "tests/support/terms.h"

namespace sinew {
namespace {

constexpr double radius = 0.7;
constexpr double stiffness = 123.0;

TEST(ObstacleLaw, ForceByHand) {
  // |r| = 0.5: 0.2 deep, pushed along (0.6, 0, 0.8) by 123 * 0.2.
  const Vec3 f = obstacle_force(Vec3(0.3, 0.0, 0.4), radius, stiffness);
  EXPECT_LT((f - 24.6 * Vec3(0.6, 0.0, 0.8)).norm(), 1e-13);
  EXPECT_NEAR(obstacle_energy(Vec3(0.3, 0.0, 0.4), radius, stiffness), 0.5 * 123 * 0.04, 1e-14);
}

TEST(ObstacleLaw, OutsideAndAtTheCentreThereIsNoForce) {
  for (const Vec3& r : {Vec3(0.8, 0, 0), Vec3(0.7, 0, 0), Vec3(0, 0, 0)}) {
    EXPECT_EQ(obstacle_force(r, radius, stiffness), Vec3::Zero());
    EXPECT_EQ(obstacle_stiffness_times(r, radius, stiffness, Vec3(1, 2, 3)), Vec3::Zero());
  }
}

TEST(ObstacleLaw, ForceIsTheNegativeGradientOfTheEnergy) {
  const double h = 1e-6;
  for (const Vec3& r : {Vec3(0.3, -0.2, 0.1), Vec3(0.05, 0.02, -0.01), Vec3(0.5, 0.5, 0.5)}) {
    const Vec3 f = obstacle_force(r, radius, stiffness);
    for (int c = 0; c < 3; ++c) {
      const Vec3 e = h * Vec3::Unit(c);
      const double slope =
          (obstacle_energy(r + e, radius, stiffness) - obstacle_energy(r - e, radius, stiffness)) /
          (2 * h);
      EXPECT_NEAR(-slope, f[c], 1e-7 * stiffness);
    }
  }
}

TEST(ObstacleLaw, StiffnessIsTheNegativeGradientOfTheForce) {
  const double h = 1e-6;
  const Vec3 u(0.4, 0.1, -0.8);
  for (const Vec3& r : {Vec3(0.3, -0.2, 0.1), Vec3(0.1, 0.6, -0.2), Vec3(0.5, 0.5, 0.5)}) {
    const Vec3 change = (obstacle_force(r + h * u, radius, stiffness) -
                         obstacle_force(r - h * u, radius, stiffness)) /
                        (2 * h);
    EXPECT_LT((obstacle_stiffness_times(r, radius, stiffness, u) + change).norm(),
              1e-7 * stiffness);
  }
}

TEST(ObstacleLaw, OnlyStiffeningIsPositiveSemidefinite) {
  const Vec3 r(0.3, 0.0, 0.0), across(0.0, 1.0, 0.0);
  EXPECT_LT(across.dot(obstacle_stiffness_times(r, radius, stiffness, across)), 0.0);
  EXPECT_EQ(across.dot(obstacle_stiffness_times(r, radius, stiffness, across, true)), 0.0);
  EXPECT_EQ(obstacle_stiffness_times(r, radius, stiffness, r, true), Vec3(stiffness * r));
}

// A box with its floor pinned and two spheres in its top and side.
Model pressed_box() {
  Model m = test::tissue_box({.law = Law::lloyd, .young = 1e4}, {3, 3, 3});
  m.start_gravity = Vec3::Zero();
  m.pins = {{"floor", test::nodes_at(m, 1, -0.05), {}}};
  Path path;
  path.keys = {{1.0, Vec3(0, -0.02, 0), Vec3::Zero()}};
  add_obstacle(m, test::soft_sphere("top", Vec3(0.01, 0.07, 0), 0.04, 1e8, path));
  add_obstacle(m, test::soft_sphere("side", Vec3(0.09, 0, 0.01), 0.05, 2e8));
  finish(m);
  return m;
}

TEST(Obstacles, SurfaceSharesAddUpToTheArea) {
  const Model m = pressed_box();
  double area = 0.0;
  for (const double a : m.surface_share) area += a;
  EXPECT_NEAR(area, 6 * 0.01, 1e-15);
  for (std::size_t i = 0; i < m.surface_share.size(); ++i)
    EXPECT_EQ(m.surface_share[i] > 0.0, m.rest_position[i].cwiseAbs().maxCoeff() > 0.049);
}

TEST(Obstacles, ForceAndProductAreTheEnergysDerivatives) {
  const Model m = pressed_box();
  const double time = 0.5, h = 1e-7;
  std::vector<Vec3> x = m.rest_position;
  for (std::size_t i = 0; i < x.size(); ++i)
    x[i] += 0.004 * (random_point(i) - Vec3::Constant(0.5));
  const auto force = [&](const std::vector<Vec3>& at) {
    std::vector<Vec3> f(at.size(), Vec3::Zero());
    ObstacleTerm::add_forces(test::at(m, at, time), f);
    return f;
  };
  const std::vector<Vec3> f = force(x);
  Index pushed = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    pushed += f[i].norm() > 0.0 ? 1 : 0;
    if (m.inverse_mass[i] == 0.0) {
      EXPECT_EQ(f[i], Vec3::Zero());
      continue;
    }
    for (int c = 0; c < 3; ++c) {
      const double at = x[i][c];
      x[i][c] = at + h;
      const double up = ObstacleTerm::energy(test::at(m, x, time));
      x[i][c] = at - h;
      const double down = ObstacleTerm::energy(test::at(m, x, time));
      x[i][c] = at;
      EXPECT_NEAR(-(up - down) / (2 * h), f[i][c], 1e-6 * 1e8 * 1e-3 * 0.01);
    }
  }
  EXPECT_GE(pushed, 5);

  std::vector<Vec3> u(x.size()), there(x), back(x), product(x.size(), Vec3::Zero());
  for (std::size_t i = 0; i < x.size(); ++i) {
    u[i] = random_point(i + 1000) - Vec3::Constant(0.5);
    there[i] += h * u[i];
    back[i] -= h * u[i];
  }
  add_stiffness_times(ObstacleTerm{}, test::at(m, x, time), Tangent::full, 2.0, u, product);
  const std::vector<Vec3> f_there = force(there), f_back = force(back);
  for (std::size_t i = 0; i < x.size(); ++i)
    EXPECT_LT((product[i] + 2.0 * (f_there[i] - f_back[i]) / (2 * h)).norm(), 1e-6 * 2e8 * 1e-3);
}

TEST(Obstacles, TheListOfTermsHasThem) {
  const Model m = pressed_box();
  State s = initial_state(m);
  s.time = 0.5;
  std::vector<Vec3> without(m.rest_position.size(), Vec3::Zero());
  ObstacleTerm::add_forces(test::at(m, s.position, s.time), without);
  const std::vector<Vec3> force =
      test::forces_at(m, initial_controls(m), s).force;  // at rest: nothing else acts
  for (std::size_t i = 0; i < without.size(); ++i)
    if (m.inverse_mass[i] > 0.0) {
      EXPECT_LT((force[i] - without[i]).norm(), 1e-12);
    }
  EXPECT_EQ(test::energies_at(m, initial_controls(m), s).contact,
            ObstacleTerm::energy(test::at(m, s.position, s.time)));
  EXPECT_GT(ObstacleTerm::energy(test::at(m, s.position, s.time)), 0.0);

  // The tangent of the stable step bounds the true one.
  std::vector<Vec3> u(without.size()), full(u.size()), bound(u.size());
  for (std::size_t i = 0; i < u.size(); ++i)
    u[i] = m.inverse_mass[i] > 0.0 ? Vec3(random_point(i) - Vec3::Constant(0.5)) : Vec3::Zero();
  test::tangent_times(test::at(m, s.position, s.time), 1.0, 0.0, u, Tangent::full, full);
  test::tangent_times(test::at(m, s.position, s.time), 1.0, 0.0, u, Tangent::only_stiffening,
                      bound);
  double of_full = 0.0, of_bound = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    of_full += u[i].dot(full[i]);
    of_bound += u[i].dot(bound[i]);
  }
  EXPECT_LT(of_full, of_bound);
}

TEST(Obstacles, ReadingsAreTheReaction) {
  const Model m = pressed_box();
  const double time = 0.5;
  const auto readings = read_obstacles(test::at(m, m.rest_position, time));
  ASSERT_EQ(readings.size(), 2U);
  EXPECT_EQ(readings[0].name, "top");
  EXPECT_LT((readings[0].center - Vec3(0.01, 0.06, 0)).norm(), 1e-15);
  EXPECT_GT(readings[0].force.y(), 0.0);  // the box pushes it up
  EXPECT_GT(readings[0].contacts, 0);
  EXPECT_NEAR(readings[1].depth,
              0.05 - (Vec3(0.09, 0, 0.01) - Vec3(0.05, 0.0166667, 0.0166667)).norm(), 1e-6);
  std::vector<Vec3> f(m.rest_position.size(), Vec3::Zero());
  ObstacleTerm::add_forces(test::at(m, m.rest_position, time), f);
  Vec3 sum = readings[0].force + readings[1].force;
  for (const Vec3& v : f) sum += v;
  EXPECT_LT(sum.norm(), 1e-9);
}

}  // namespace
}  // namespace sinew
