#include "sinew/forces/volume_law.h"

#include <gtest/gtest.h>

#include "sinew/base/random.h"

namespace sinew {
namespace {

double volume(const Corners& x) {
  return (x[3] - x[0]).dot((x[1] - x[0]).cross(x[2] - x[0])) / 6.0;
}
Corners gradient(const Corners& x) {
  return volume_gradient(x[1] - x[0], x[2] - x[0], x[3] - x[0]);
}

TEST(VolumeLaw, GradientsAreTheDerivativesOfTheVolume) {
  const Corners x = {random_point(1), random_point(2), random_point(3), random_point(4)};
  const Corners u = {random_point(5), random_point(6), random_point(7), random_point(8)};
  const double e = 1e-6;
  Corners up = x, down = x;
  for (std::size_t a = 0; a < 4; ++a) {
    up[a] += e * u[a];
    down[a] -= e * u[a];
  }
  const Corners g = gradient(x);
  double slope = 0.0;
  for (std::size_t a = 0; a < 4; ++a) slope += g[a].dot(u[a]);
  EXPECT_NEAR((volume(up) - volume(down)) / (2.0 * e), slope, 1e-9);
  EXPECT_LT((g[0] + g[1] + g[2] + g[3]).norm(), 1e-15);  // a shift changes no volume

  const Corners change = volume_gradient_change(x[1] - x[0], x[2] - x[0], x[3] - x[0], u[1] - u[0],
                                                u[2] - u[0], u[3] - u[0]);
  for (std::size_t a = 0; a < 4; ++a) {
    const Vec3 expected = (gradient(up)[a] - gradient(down)[a]) / (2.0 * e);
    EXPECT_LT((change[a] - expected).norm(), 1e-9);
  }
}

TEST(VolumeLaw, TheGuardActsBelowItsThresholdAlone) {
  const double mu = 3.0, e = 1e-6;
  for (const double ratio : {guard_threshold, 0.7, 1.0, 3.0}) {
    EXPECT_EQ(guard_pressure(ratio, mu), 0.0);
    EXPECT_EQ(guard_energy(ratio, mu), 0.0);
    EXPECT_EQ(guard_stiffness(ratio, mu), 0.0);
  }
  for (const double ratio : {0.39, 0.2, 0.01, -0.5}) {
    const double slope = (guard_energy(ratio + e, mu) - guard_energy(ratio - e, mu)) / (2.0 * e);
    EXPECT_NEAR(guard_pressure(ratio, mu), slope, 1e-6) << ratio;
    EXPECT_LT(guard_pressure(ratio, mu), 0.0) << ratio;
    const double bend = (guard_pressure(ratio + e, mu) - guard_pressure(ratio - e, mu)) / (2.0 * e);
    EXPECT_NEAR(guard_stiffness(ratio, mu), bend, 1e-5) << ratio;
  }
}

}  // namespace
}  // namespace sinew
