#include "sinew/contact/closest.h"

#include <gtest/gtest.h>

#include "sinew/base/random.h"
#include "tests/support/fields.h"

namespace sinew {
namespace {

using test::somewhere;

TEST(Closest, NoSampledPairIsNearer) {
  std::uint64_t seed = 5000000;
  int pierced = 0;
  for (int i = 0; i < 300; ++i) {
    const Corners t = {somewhere(seed), somewhere(seed), somewhere(seed)};
    const Vec3 a = somewhere(seed);
    const Vec3 b = i % 5 == 0 ? a : somewhere(seed);
    const NearestPair p = nearest_of_segment_and_triangle(a, b, t);
    EXPECT_NEAR(p.weight.sum(), 1.0, 1e-12);
    EXPECT_GE(p.weight.minCoeff(), 0.0);
    EXPECT_LT((p.on_segment - (a + p.share * (b - a))).norm(), 1e-14);
    EXPECT_NEAR((p.on_triangle - p.on_segment).norm(), p.distance, 1e-12);
    pierced += p.distance == 0.0 ? 1 : 0;
    double nearest = 10.0;
    const int n = 24;
    for (int u = 0; u <= n; ++u)
      for (int v = 0; u + v <= n; ++v)
        for (int s = 0; s <= n; ++s) {
          const double w[3] = {1.0 * u / n, 1.0 * v / n, 1.0 * (n - u - v) / n};
          const Vec3 x = w[0] * t[0] + w[1] * t[1] + w[2] * t[2];
          nearest = std::min(nearest, (x - a - 1.0 * s / n * (b - a)).norm());
        }
    EXPECT_LE(p.distance, nearest + 1e-12);
    EXPECT_GT(p.distance, nearest - 0.15);
  }
  EXPECT_GT(pierced, 10);
}

TEST(Closest, PlacesOnAnEdgeHaveExactZeros) {
  const Corners t = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)};
  EXPECT_EQ(nearest_in_triangle(Vec3(0.25, 1, -3), t), Vec3(0.75, 0.25, 0));
  EXPECT_EQ(nearest_in_triangle(Vec3(-1, 2, -3), t), Vec3(1, 0, 0));
  EXPECT_EQ(nearest_in_triangle(Vec3(2, 2, 2), t), Vec3(0, 0.5, 0.5));
}

TEST(Closest, DegenerateTrianglesAndSegmentsGiveNumbers) {
  const Vec3 p(0.3, 0.2, 0.1);
  for (const Corners& t :
       {Corners{p, p, p}, Corners{p, Vec3(2 * p), Vec3(3 * p)}, Corners{p, p, Vec3(2 * p)}}) {
    for (const Vec3& a : {p, Vec3(1, 0, 0)}) {
      for (const Vec3& b : {p, Vec3(0, 1, 0)}) {
        const NearestPair pair = nearest_of_segment_and_triangle(a, b, t);
        EXPECT_TRUE(pair.weight.allFinite());
        EXPECT_TRUE(std::isfinite(pair.distance));
      }
    }
  }
}

}  // namespace
}  // namespace sinew
