#include "sinew/contact/nearest.h"

#include <gtest/gtest.h>

#include <random>

namespace sinew {
namespace {

Vec3 random_vec(std::mt19937& rng) {
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  return {u(rng), u(rng), u(rng)};
}

TEST(Nearest, NoSampleOfATriangleIsNearer) {
  std::mt19937 rng(1);
  for (int n = 0; n < 300; ++n) {
    const Vec3 a = random_vec(rng), b = random_vec(rng), p = 2.0 * random_vec(rng);
    Vec3 c = random_vec(rng);
    if (n % 5 == 0) c = a + 0.3 * (b - a);  // no area
    if (n % 15 == 0) c = a;
    const OnTriangle on = nearest_on_triangle(p, a, b, c);
    EXPECT_NEAR((on.weight[0] * a + on.weight[1] * b + on.weight[2] * c - on.point).norm(), 0.0,
                1e-12);
    EXPECT_NEAR((p - on.point).norm(), std::sqrt(on.distance2), 1e-12);
    EXPECT_NEAR(on.weight[0] + on.weight[1] + on.weight[2], 1.0, 1e-12);
    for (const double w : on.weight) EXPECT_GE(w, 0.0);
    for (int i = 0; i <= 30; ++i) {
      for (int j = 0; i + j <= 30; ++j) {
        const Vec3 q = a + i / 30.0 * (b - a) + j / 30.0 * (c - a);
        EXPECT_LE(std::sqrt(on.distance2), (p - q).norm() + 1e-12);
      }
    }
  }
}

TEST(Nearest, NoSamplesOfTwoSegmentsAreNearer) {
  std::mt19937 rng(2);
  for (int n = 0; n < 300; ++n) {
    const Vec3 a = random_vec(rng), b = random_vec(rng), c = random_vec(rng);
    const Vec3 d = n % 5 == 0 ? Vec3(c + 0.7 * (b - a)) : random_vec(rng);  // parallel
    const double distance = segments_distance(a, b, c, d);
    double least = 10.0;
    for (int i = 0; i <= 60; ++i) {
      for (int j = 0; j <= 60; ++j) {
        least = std::min(least, (a + i / 60.0 * (b - a) - c - j / 60.0 * (d - c)).norm());
      }
    }
    EXPECT_LE(distance, least + 1e-12);
    EXPECT_NEAR(distance, least, 0.06);
  }
}

}  // namespace
}  // namespace sinew
