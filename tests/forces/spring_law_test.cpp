#include "sinew/forces/spring_law.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sinew {
namespace {

// Design 3.1 by hand: x_ij = (0, 3, 4) of length 5, k = 10, l0 = 4: spring force 10 * 1 along
// (0, .6, .8); v_ij = (1, 2, 0): v.x / x.x = 6/25, c = 5: dashpot (0, 3.6, 4.8).
TEST(SpringLaw, ForceByHand) {
  const Vec3 f = spring_force(Vec3(0, 3, 4), Vec3(1, 2, 0), 10.0, 4.0, 5.0).force;
  EXPECT_NEAR(f.x(), 0.0, 1e-15);
  EXPECT_NEAR(f.y(), 6.0 + 3.6, 1e-14);
  EXPECT_NEAR(f.z(), 8.0 + 4.8, 1e-14);
}

TEST(SpringLaw, EndsThatCoincideExertNoForce) {
  EXPECT_EQ(spring_force(Vec3::Zero(), Vec3(1, 0, 0), 10.0, 1.0, 5.0).force, Vec3::Zero());
}

TEST(SpringLaw, ForceIsTheNegativeGradientOfTheEnergy) {
  const Vec3 x(0.3, -0.7, 0.2);
  const double k = 123.0, l0 = 0.6, h = 1e-6;
  // The energy falls when x_i moves along the force on i; x_ij = x_j - x_i, so dE/dx_ij = +f.
  const Vec3 f = spring_force(x, Vec3::Zero(), k, l0, 0.0).force;
  for (int c = 0; c < 3; ++c) {
    Vec3 e = Vec3::Zero();
    e[c] = h;
    const double slope = (spring_energy(x + e, k, l0) - spring_energy(x - e, k, l0)) / (2 * h);
    EXPECT_NEAR(slope, f[c], 1e-7 * f.norm());
  }
}

TEST(SpringLaw, StiffnessIsTheGradientOfTheForce) {
  const double k = 123.0, l0 = 0.6, h = 1e-6;
  for (const Vec3& x : {Vec3(0.3, -0.7, 0.2), Vec3(0.1, 0.2, -0.1)}) {  // stretched, compressed
    const Vec3 u(0.4, 0.1, -0.8);
    const Vec3 change = (spring_force(x + h * u, Vec3::Zero(), k, l0, 0.0).force -
                         spring_force(x - h * u, Vec3::Zero(), k, l0, 0.0).force) /
                        (2 * h);
    EXPECT_LT((spring_stiffness_times(x, k, l0, u) - change).norm(), 1e-7 * k);
  }
}

TEST(SpringLaw, OnlyStiffeningIsPositiveAndLeavesStretchedSpringsAlone) {
  const Vec3 squeezed(0.1, 0.0, 0.0), across(0.0, 1.0, 0.0);
  EXPECT_LT(across.dot(spring_stiffness_times(squeezed, 10.0, 0.5, across)), 0.0);
  EXPECT_EQ(across.dot(spring_stiffness_times(squeezed, 10.0, 0.5, across, true)), 0.0);
  const Vec3 stretched(1.0, 0.0, 0.0);
  EXPECT_EQ(spring_stiffness_times(stretched, 10.0, 0.5, across, true),
            spring_stiffness_times(stretched, 10.0, 0.5, across));
}

TEST(SpringLaw, DashpotPowerAndProduct) {
  const Vec3 x(0, 0, 2), v(1, 0, 3);
  EXPECT_DOUBLE_EQ(spring_force(x, v, 0.0, 1.0, 2.0).heat, 2.0 * 9.0);
  EXPECT_DOUBLE_EQ(v.dot(dashpot_times(x, 2.0, v)), 2.0 * 9.0);
}

}  // namespace
}  // namespace sinew
