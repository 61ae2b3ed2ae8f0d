#include "sinew/solver/bound.h"

#include <gtest/gtest.h>

#include "sinew/base/random.h"

namespace sinew {
namespace {

TEST(Bound, PullsWhatIsOutsideAndNothingElse) {
  EXPECT_EQ(bound_force(0.5, 0.0, 1.0, 10.0, 0.0), 0.0);
  EXPECT_DOUBLE_EQ(bound_force(1.2, 0.0, 1.0, 10.0, 0.0), 2.0);
  EXPECT_DOUBLE_EQ(bound_force(-0.1, 0.0, 1.0, 10.0, 0.0), -1.0);
  // At the bound the force is the multiplier, whatever the stiffness.
  for (const double k : {1.0, 1e3, 1e6}) {
    EXPECT_NEAR(bound_force(1.0, 0.0, 1.0, k, 3.0), 3.0, 1e-9);
    EXPECT_NEAR(bound_force(0.0, 0.0, 1.0, k, -3.0), -3.0, 1e-9);
  }
  // A multiplier that pulls back within the interval is given up.
  EXPECT_EQ(bound_force(0.5, 0.0, 1.0, 10.0, 3.0), 0.0);
}

TEST(Bound, PullAndStiffnessAreTheDerivativesOfTheEnergy) {
  const double e = 1e-6, k = 10.0;
  for (const double p : {-2.0, 0.0, 1.5}) {
    for (const double q : {-0.7, -0.05, 0.3, 0.6, 1.1, 1.9}) {
      const auto energy = [&](double at) { return bound_energy(at, 0.0, 1.0, k, p); };
      const auto force = [&](double at) { return bound_force(at, 0.0, 1.0, k, p); };
      EXPECT_NEAR((energy(q + e) - energy(q - e)) / (2.0 * e), force(q), 1e-7) << q << " " << p;
      EXPECT_NEAR((force(q + e) - force(q - e)) / (2.0 * e), bound_stiffness(q, 0.0, 1.0, k, p),
                  1e-6)
          << q << " " << p;
    }
  }
}

TEST(Friction, SticksUpToItsLimitAndThenSlides) {
  const Vec3 u(0.01, 0.0, 0.0);
  EXPECT_LT((friction_force(u, 5.0, 100.0, Vec3::Zero()) - 100.0 * u).norm(), 1e-15);
  EXPECT_LT((friction_force(100.0 * u, 5.0, 100.0, Vec3::Zero()) - Vec3(5.0, 0.0, 0.0)).norm(),
            1e-12);
}

TEST(Friction, PullAndStiffnessAreTheDerivativesOfTheEnergy) {
  const Vec3 n = Vec3::UnitY();
  const Mat3 plane = Mat3::Identity() - n * n.transpose();
  const double e = 1e-6, k = 50.0;
  for (std::size_t i = 0; i < 20; ++i) {
    const Vec3 u = plane * (random_point(i) - Vec3::Constant(0.5));
    const Vec3 p = plane * (random_point(100 + i) - Vec3::Constant(0.5));
    const Vec3 direction = plane * (random_point(200 + i) - Vec3::Constant(0.5));
    const double r = i % 2 == 0 ? 2.0 : 200.0;  // slides, sticks
    const double slope = (friction_energy(u + e * direction, r, k, p) -
                          friction_energy(u - e * direction, r, k, p)) /
                         (2.0 * e);
    EXPECT_NEAR(slope, friction_force(u, r, k, p).dot(direction), 1e-6);
    const Vec3 change =
        (friction_force(u + e * direction, r, k, p) - friction_force(u - e * direction, r, k, p)) /
        (2.0 * e);
    EXPECT_LT((change - friction_stiffness(u, r, k, p, n) * direction).norm(), 1e-5);
  }
}

}  // namespace
}  // namespace sinew
