#include "sinew/live/quantity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/live/support.h"

namespace sinew::live {
namespace {

TEST(Quantity, QuantitiesAreThoseOfAKnownDeformation) {
  Session s(test::hanging_box());
  State stretched = s.state();
  for (std::size_t i = 0; i < stretched.position.size(); ++i) {
    stretched.position[i].x() *= 1.1;
    stretched.half_velocity[i] = Vec3(0, 3, 4);
  }
  const auto all_near = [&](Quantity q, double value, double tolerance) {
    for (const float v : measure(q, s.model(), stretched, *s.topology())) {
      EXPECT_NEAR(v, value, tolerance) << info(q).name;
    }
  };
  all_near(Quantity::volume, 0.1, 1e-6);
  all_near(Quantity::speed, 5.0, 1e-6);
  all_near(Quantity::region, 0.0, 0.0);
  // mu / J |B_xx - B_yy| for a uniaxial B.
  const double mu = shear_modulus(2e4, 0.45);
  all_near(Quantity::stress, mu / 1.1 * (1.21 - 1.0), 1e-3 * mu);
  EXPECT_NEAR(measure(Quantity::stretch, s.model(), stretched, *s.topology()).at(0), 0.1, 1e-6);
  all_near(Quantity::energy, 0.5 * mu * ((1.21 + 2.0) / std::cbrt(1.21) - 3.0), 1e-3 * mu);
  EXPECT_EQ(distortion_energy(1e3, -Mat3::Identity()), 0.0);
  EXPECT_NEAR(distortion_energy(1e3, 1.3 * Mat3::Identity()), 0.0, 1e-9);
  EXPECT_EQ(quantity_named("speed"), Quantity::speed);
  EXPECT_FALSE(quantity_named("nothing").has_value());
}

}  // namespace
}  // namespace sinew::live
