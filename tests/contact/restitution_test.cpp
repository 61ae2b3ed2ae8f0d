#include "sinew/contact/restitution.h"

#include <gtest/gtest.h>

#include "sinew/base/random.h"

namespace sinew {
namespace {

// A flight over a step of length h from the gap s with the velocity v0 [m/s] under a [m/s2], as
// rebound() is given it: the gap and the half-step velocity at the end, without the plane.
Rebound of_flight(double s, double v0, double a, double h, double restitution) {
  const double w = v0 + 0.5 * h * a;
  return rebound(s + h * w, w, a, h, restitution);
}

// With e = 1 the energy v^2/2 - a s at the end of the step is what it was at its start.
TEST(Restitution, AFullReboundKeepsTheEnergy) {
  std::uint64_t seed = 1;
  const double h = 0.1;
  for (int i = 0; i < 200; ++i) {
    const double s = 0.05 * random_number(seed++);
    const double v0 = -2.0 - random_number(seed++);
    const double a = -10.0 * random_number(seed++);
    const Rebound r = of_flight(s, v0, a, h, 1.0);
    const double v = r.velocity + 0.5 * h * a;  // at the end of the step
    ASSERT_GT(r.gap, 0.0);
    EXPECT_NEAR(0.5 * v * v - a * r.gap, 0.5 * v0 * v0 - a * s, 1e-12);
    EXPECT_NEAR(r.loss, 0.0, 1e-12);
  }
}

TEST(Restitution, ItLosesOneMinusESquaredOfTheImpact) {
  const double e = 0.6;
  const Rebound r = of_flight(0.05, -2.0, -10.0, 0.1, e);
  const double impact2 = 4.0 + 2.0 * 10.0 * 0.05;
  EXPECT_NEAR(r.loss, 0.5 * (1.0 - e * e) * impact2, 1e-14);
  EXPECT_GT(r.left, 0.0);
  EXPECT_LT(r.left, 0.1);
}

// What would land again within the step is at rest, and a body that lies still loses nothing.
TEST(Restitution, SmallBouncesComeToRest) {
  const Rebound lands = of_flight(0.001, -0.01, -10.0, 0.1, 0.5);
  EXPECT_EQ(lands.gap, 0.0);
  EXPECT_EQ(lands.velocity, 0.0);
  EXPECT_GT(lands.loss, 0.0);
  const Rebound lies = of_flight(0.0, 0.0, -10.0, 0.1, 0.5);
  EXPECT_EQ(lies.velocity, 0.0);
  EXPECT_EQ(lies.loss, 0.0);
}

}  // namespace
}  // namespace sinew
