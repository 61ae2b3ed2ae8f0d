#include "sinew/contact/shapes.h"

#include <gtest/gtest.h>

#include <functional>

#include "sinew/base/random.h"
#include "tests/support/fields.h"

namespace sinew {
namespace {

using test::somewhere;

struct Named {
  const char* name;
  std::function<SurfacePoint(const Vec3&)> surface;
  std::function<std::optional<double>(const Vec3&, const Vec3&)> enters;
};

const Vec3 half(0.5, 0.2, 0.35);

const std::vector<Named>& shapes() {
  static const std::vector<Named> all = {
      {"plane", plane_surface, enters_plane},
      {"sphere", [](const Vec3& q) { return sphere_surface(q, 0.4); },
       [](const Vec3& a, const Vec3& b) { return enters_sphere(a, b, 0.4); }},
      {"capsule", [](const Vec3& q) { return capsule_surface(q, 0.5, 0.2); },
       [](const Vec3& a, const Vec3& b) { return enters_capsule(a, b, 0.5, 0.2); }},
      {"box", [](const Vec3& q) { return box_surface(q, half); },
       [](const Vec3& a, const Vec3& b) { return enters_box(a, b, half); }},
  };
  return all;
}

TEST(Shapes, TheNearestPointIsOnTheSurfaceAlongTheNormal) {
  std::uint64_t seed = 1000000;
  for (const Named& shape : shapes()) {
    for (int i = 0; i < 2000; ++i) {
      const Vec3 q = somewhere(seed);
      const SurfacePoint p = shape.surface(q);
      EXPECT_NEAR(p.normal.norm(), 1.0, 1e-14) << shape.name;
      EXPECT_LT((p.nearest + p.distance * p.normal - q).norm(), 1e-14) << shape.name;
      EXPECT_NEAR(shape.surface(p.nearest).distance, 0.0, 1e-14) << shape.name;
    }
  }
}

// Nothing of the surface is nearer: seen from every outside point, the ball of that radius is free.
TEST(Shapes, NoSurfacePointIsNearer) {
  std::uint64_t seed = 2000000;
  for (const Named& shape : shapes()) {
    std::vector<Vec3> surface;
    for (int i = 0; i < 4000; ++i) surface.push_back(shape.surface(somewhere(seed)).nearest);
    for (int i = 0; i < 50; ++i) {
      const Vec3 q = somewhere(seed);
      double nearest = 10.0;
      for (const Vec3& s : surface) nearest = std::min(nearest, (s - q).norm());
      const double distance = std::abs(shape.surface(q).distance);
      EXPECT_LE(distance, nearest + 1e-14) << shape.name;
      EXPECT_GT(distance, nearest - 0.15) << shape.name;  // as dense as the samples are
    }
  }
}

TEST(Shapes, TheNormalIsTheGradientOfTheDistance) {
  std::uint64_t seed = 3000000;
  const double h = 1e-6;
  for (const Named& shape : shapes()) {
    for (int i = 0; i < 500; ++i) {
      const Vec3 q = somewhere(seed);
      Vec3 gradient;
      for (int a = 0; a < 3; ++a)
        gradient[a] = (shape.surface(q + h * Vec3::Unit(a)).distance -
                       shape.surface(q - h * Vec3::Unit(a)).distance) /
                      (2 * h);
      // Near a place that is as far from two parts of the surface there is no gradient.
      if (std::abs(gradient.norm() - 1.0) > 1e-6) continue;
      EXPECT_LT((gradient - shape.surface(q).normal).norm(), 1e-5) << shape.name;
    }
  }
}

TEST(Shapes, EntriesAreThePlacesWhereASampledWayGoesIn) {
  std::uint64_t seed = 4000000;
  for (const Named& shape : shapes()) {
    int met = 0;
    for (int i = 0; i < 3000; ++i) {
      const Vec3 a = somewhere(seed);
      const Vec3 b = somewhere(seed);
      const auto s = shape.enters(a, b);
      if (shape.surface(a).distance <= 0.0) {
        EXPECT_FALSE(s) << shape.name;
        continue;
      }
      double lowest = 1.0;
      for (int k = 0; k <= 200; ++k)
        lowest = std::min(lowest, shape.surface(a + k / 200.0 * (b - a)).distance);
      if (!s) {
        EXPECT_GT(lowest, -1e-14) << shape.name;
        continue;
      }
      ++met;
      EXPECT_GE(*s, 0.0);
      EXPECT_LE(*s, 1.0);
      EXPECT_NEAR(shape.surface(a + *s * (b - a)).distance, 0.0, 1e-12) << shape.name;
      for (int k = 0; k < 50; ++k)
        EXPECT_GT(shape.surface(a + k / 50.0 * *s * (b - a)).distance, -1e-14) << shape.name;
    }
    EXPECT_GT(met, 100) << shape.name;
  }
}

TEST(Shapes, AtTheCentreThereIsAFixedWayOut) {
  EXPECT_EQ(sphere_surface(Vec3::Zero(), 2.0).normal, Vec3::UnitY());
  EXPECT_EQ(sphere_surface(Vec3::Zero(), 2.0).distance, -2.0);
  EXPECT_EQ(capsule_surface(Vec3(0, 0, 0.1), 0.5, 0.2).nearest, Vec3(0, 0.2, 0.1));
  EXPECT_EQ(box_surface(Vec3::Zero(), half).nearest, Vec3(0, 0.2, 0));
}

}  // namespace
}  // namespace sinew
