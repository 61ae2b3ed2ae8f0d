#include "sinew/forces/strain_limits.h"

#include <gtest/gtest.h>

#include "sinew/base/parallel.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

using test::add_limited;
using test::point_masses;

TEST(Limits, OneSpringGoesExactlyOntoItsLimitByInverseMasses) {
  Model m = point_masses({{Vec3(0, 0, 0), 1.0}, {Vec3(1, 0, 0), 3.0}});
  add_limited(m, 0, 1, 10.0, 1.0, 0.1, 0.2);
  finish(m);
  // Stretched to 1.5: 0.4 too long; the light end takes 3/4 of it.
  std::vector<Vec3> x = {Vec3(0, 0, 0), Vec3(1.5, 0, 0)};
  EXPECT_NEAR(measure_limit_violation(m, x), 0.4, 1e-15);
  EXPECT_EQ(sweep_limits(m, x).moved, 1);
  EXPECT_NEAR(x[0].x(), 0.3, 1e-15);
  EXPECT_NEAR(x[1].x(), 1.4, 1e-15);
  EXPECT_NEAR(measure_limit_violation(m, x), 0.0, 1e-15);
  EXPECT_EQ(sweep_limits(m, x).moved, 0);
  // Compressed to 0.5: 0.3 too short.
  x = {Vec3(0, 0, 0), Vec3(0, 0.5, 0)};
  EXPECT_EQ(sweep_limits(m, x).moved, 1);
  EXPECT_NEAR((x[1] - x[0]).norm(), 0.8, 1e-15);
  EXPECT_NEAR(x[0].y(), -0.225, 1e-15);
}

TEST(Limits, WithinTheLimitsNothingMoves) {
  Model m = point_masses({{Vec3(0, 0, 0), 1.0}, {Vec3(1, 0, 0), 1.0}});
  add_limited(m, 0, 1, 10.0, 1.0, 0.1, 0.2);
  finish(m);
  for (const double length : {0.81, 1.0, 1.09}) {
    std::vector<Vec3> x = {Vec3(0, 0, 0), Vec3(length, 0, 0)};
    EXPECT_EQ(sweep_limits(m, x).moved, 0);
    EXPECT_EQ(x[1].x(), length);
  }
}

TEST(Limits, HeldEndsStay) {
  Model m = point_masses({{Vec3(0, 0, 0), 0.0}, {Vec3(1, 0, 0), 1.0}});
  add_limited(m, 0, 1, 10.0, 1.0, 0.1, 0.2);
  finish(m);
  std::vector<Vec3> x = {Vec3(0, 0, 0), Vec3(2, 0, 0)};
  sweep_limits(m, x);
  EXPECT_EQ(x[0], Vec3::Zero());
  EXPECT_NEAR(x[1].x(), 1.1, 1e-15);
}

TEST(Limits, ADistanceIsKeptExactlyHoweverLittleItIsOff) {
  Model m = point_masses({{Vec3(0, 0, 0), 1.0}, {Vec3(1, 0, 0), 3.0}});
  add_distance(m, 0, 1, 1.0, false);
  finish(m);
  for (const double length : {1.0001, 0.9999, 1.2, 0.5}) {
    std::vector<Vec3> x = {Vec3(0, 0, 0), Vec3(0, length, 0)};
    const LimitSweep sweep = sweep_limits(m, x);
    EXPECT_EQ(sweep.moved, 1);
    EXPECT_EQ(sweep.over, std::abs(length - 1.0) > m.limit_tolerance ? 1 : 0);
    EXPECT_NEAR((x[1] - x[0]).norm(), 1.0, 1e-15);
    EXPECT_NEAR(x[0].y() + 3.0 * x[1].y(), 3.0 * length, 1e-15);
  }
}

TEST(Limits, ARopeMayBeSlack) {
  Model m = point_masses({{Vec3(0, 0, 0), 0.0}, {Vec3(1, 0, 0), 1.0}});
  add_distance(m, 0, 1, 1.0, true);
  finish(m);
  std::vector<Vec3> x = {Vec3(0, 0, 0), Vec3(0.3, 0, 0)};
  EXPECT_EQ(sweep_limits(m, x).moved, 0);
  x[1].x() = 1.0001;
  EXPECT_EQ(sweep_limits(m, x).moved, 1);
  EXPECT_NEAR(x[1].x(), 1.0, 1e-15);
}

TEST(Limits, SweepsKeepTheCentreOfMassAndReachTheTolerance) {
  Material material;
  material.stretch_limit = 0.1;
  material.compress_limit = 0.1;
  Model m = test::tissue_box(material, {4, 4, 4});
  m.limit_tolerance = 1e-3;
  finish(m);
  std::vector<Vec3> x = m.rest_position;
  for (Vec3& p : x) p = Vec3(1.4 * p.x(), 0.95 * p.y(), 0.95 * p.z());
  const auto center = [&] {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < x.size(); ++i) sum += m.mass[i] * x[i];
    return sum;
  };
  const Vec3 before = center();
  int sweeps = 0;
  while (sweep_limits(m, x).over > 0 && sweeps < 500) ++sweeps;
  EXPECT_LT(sweeps, 500);
  EXPECT_LE(measure_limit_violation(m, x), 1e-3);
  EXPECT_LT((center() - before).norm(), 1e-15);
}

TEST(Limits, SameBitsAtAnyThreadCount) {
  Material material;
  material.stretch_limit = 0.05;
  Model m = test::tissue_box(material, {12, 12, 12});
  finish(m);
  std::vector<std::vector<Vec3>> results;
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    std::vector<Vec3> x = m.rest_position;
    for (Vec3& p : x) p.x() *= 1.3;
    for (int i = 0; i < 5; ++i) sweep_limits(m, x);
    results.push_back(x);
  }
  EXPECT_EQ(results[0], results[1]);
}

}  // namespace
}  // namespace sinew
