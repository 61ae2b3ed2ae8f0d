#include "sinew/model/material.h"

#include <gtest/gtest.h>

namespace sinew {
namespace {

// E (1 - nu) / ((1 + nu)(1 - 2 nu)) is the modulus of a strain in one direction alone.
TEST(Material, PressureWavesHaveTheirSpeed) {
  Material m;
  m.young = 1e4;
  m.density = 1000.0;
  m.poisson = 0.0;
  EXPECT_NEAR(pressure_wave_speed(m), std::sqrt(10.0), 1e-12);
  m.poisson = 0.45;
  EXPECT_NEAR(pressure_wave_speed(m), std::sqrt(10.0 * 0.55 / (1.45 * 0.1)), 1e-12);
  m.poisson = 0.4999999;
  const double limited = pressure_wave_speed(m);
  m.poisson = 0.499;
  EXPECT_EQ(pressure_wave_speed(m), limited);
}

}  // namespace
}  // namespace sinew
