#include "sinew/contact/time_of_impact.h"

#include <gtest/gtest.h>

#include <random>

namespace sinew {
namespace {

TEST(TimeOfImpact, RootsOfCubicsWithKnownOnes) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> u(-0.5, 1.5);
  for (int n = 0; n < 2000; ++n) {
    std::array<double, 3> r = {u(rng), u(rng), u(rng)};
    std::sort(r.begin(), r.end());
    if (r[1] - r[0] < 1e-3 || r[2] - r[1] < 1e-3) continue;
    const double s = n % 2 ? 1e-9 : -1e3;
    const Cubic f = {{-s * r[0] * r[1] * r[2], s * (r[0] * r[1] + r[0] * r[2] + r[1] * r[2]),
                      -s * (r[0] + r[1] + r[2]), s}};
    const Roots found = crossings(f);
    int expected = 0;
    for (const double t : r) {
      if (t <= 0.0 || t >= 1.0) continue;
      ASSERT_LT(expected, found.count);
      EXPECT_NEAR(found.t[static_cast<std::size_t>(expected++)], t, 1e-9);
    }
    EXPECT_EQ(found.count, expected);
  }
}

TEST(TimeOfImpact, ANodeThatIsShotAtAPointOfATriangleThatMoves) {
  std::mt19937 rng(2);
  std::uniform_real_distribution<double> u(-1.0, 1.0), share(0.05, 1.0);
  const auto vec = [&] { return Vec3(u(rng), u(rng), u(rng)); };
  int hits = 0;
  for (int n = 0; n < 1000; ++n) {
    NodeAndTriangle m;
    m.a0 = vec(), m.b0 = vec(), m.c0 = vec();
    m.a1 = m.a0 + 0.1 * vec(), m.b1 = m.b0 + 0.1 * vec(), m.c1 = m.c0 + 0.1 * vec();
    // At `time` it is at the place with these weights, from far in front of the triangle.
    const double time = 0.8 * share(rng);
    Vec3 w(share(rng), share(rng), share(rng));
    w /= w.sum();
    const Vec3 a = between(m.a0, m.a1, time), b = between(m.b0, m.b1, time),
               c = between(m.c0, m.c1, time);
    const Vec3 normal = (b - a).cross(c - a).normalized();
    if ((b - a).cross(c - a).norm() < 0.3) continue;
    const Vec3 displacement = -5.0 * normal + vec();
    m.p0 = w[0] * a + w[1] * b + w[2] * c - time * displacement;
    m.p1 = m.p0 + displacement;
    const TimeOfImpact hit = impact_of_node(m);
    ASSERT_TRUE(hit.found);
    EXPECT_NEAR(hit.time, time, 1e-9);
    EXPECT_NEAR((hit.normal - normal).norm(), 0.0, 1e-7);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(hit.weight[k], w[static_cast<Index>(k)], 1e-7);
    std::swap(m.p0, m.p1);  // backwards it comes out, which is no impact
    std::swap(m.a0, m.a1), std::swap(m.b0, m.b1), std::swap(m.c0, m.c1);
    EXPECT_FALSE(impact_of_node(m).found);
    ++hits;
  }
  EXPECT_GT(hits, 500);
}

TEST(TimeOfImpact, EdgesThatCross) {
  NodeAndTriangle m;  // along x, falling from 1 to -1; along z at height 0, at rest
  m.p0 = Vec3(-1, 1, 0), m.a0 = Vec3(1, 1, 0), m.p1 = Vec3(-1, -1, 0), m.a1 = Vec3(1, -1, 0);
  m.b0 = m.b1 = Vec3(0.5, 0, -1), m.c0 = m.c1 = Vec3(0.5, 0, 3);
  const TimeOfImpact hit = impact_of_edges(m);
  ASSERT_TRUE(hit.found);
  EXPECT_NEAR(hit.time, 0.5, 1e-12);
  EXPECT_NEAR(hit.weight[0], 0.75, 1e-12);
  EXPECT_NEAR(hit.weight[1], 0.25, 1e-12);
  EXPECT_LT((hit.normal - Vec3::UnitY()).norm(), 1e-12);
  m.b0 = m.b1 = Vec3(1.5, 0, -1), m.c0 = m.c1 = Vec3(1.5, 0, 3);
  EXPECT_FALSE(impact_of_edges(m).found);
}

}  // namespace
}  // namespace sinew
