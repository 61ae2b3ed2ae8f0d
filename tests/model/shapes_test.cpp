#include "sinew/model/shapes/shape.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "sinew/base/random.h"
#include "tests/support/fields.h"

namespace sinew {
namespace {

using shapes::SurfacePoint;
using test::somewhere;

struct Named {
  std::string name;
  std::function<SurfacePoint(const Vec3&)> surface;
  std::function<std::optional<double>(const Vec3&, const Vec3&)> enters;
  std::function<Vec3(const Mat3&)> extent;
  double farthest = 0.0;
  std::vector<shapes::Rod> rods;
};

// Every solid shape that there is, of sizes that differ.
const std::vector<Named>& shapes_of_all_kinds() {
  static const std::vector<Named> all = [] {
    std::vector<Named> out;
    for_each_shape([&](const auto& shape) {
      if constexpr (SolidShape<std::decay_t<decltype(shape)>>) {
        const auto s = shape.from({0.4, 1.0, Vec3(1.0, 0.4, 0.7)});
        out.push_back({std::string(s.word), [s](const Vec3& q) { return s.surface(q); },
                       [s](const Vec3& a, const Vec3& b) { return s.enters(a, b); },
                       [s](const Mat3& turn) { return Vec3(s.extent(turn)); }, s.farthest(),
                       s.rods(1.0)});
      }
    });
    return out;
  }();
  return all;
}

TEST(Shapes, TheNearestPointIsOnTheSurfaceAlongTheNormal) {
  std::uint64_t seed = 1000000;
  for (const Named& shape : shapes_of_all_kinds()) {
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
  for (const Named& shape : shapes_of_all_kinds()) {
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
  for (const Named& shape : shapes_of_all_kinds()) {
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
  for (const Named& shape : shapes_of_all_kinds()) {
    int hits = 0;
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
      ++hits;
      EXPECT_GE(*s, 0.0);
      EXPECT_LE(*s, 1.0);
      EXPECT_NEAR(shape.surface(a + *s * (b - a)).distance, 0.0, 1e-12) << shape.name;
      for (int k = 0; k < 50; ++k)
        EXPECT_GT(shape.surface(a + k / 50.0 * *s * (b - a)).distance, -1e-14) << shape.name;
    }
    EXPECT_GT(hits, 100) << shape.name;
  }
}

// Points inside are within the extent in any turn, and no farther away than it says.
TEST(Shapes, TheExtentHoldsTheShape) {
  std::uint64_t seed = 5000000;
  for (const Named& shape : shapes_of_all_kinds()) {
    for (int i = 0; i < 500; ++i) {
      const Vec3 q = shape.surface(somewhere(seed)).nearest;
      EXPECT_LE(q.norm(), shape.farthest + 1e-14) << shape.name;
      const Mat3 turn = Eigen::AngleAxisd(3.0 * random_number(seed++), somewhere(seed).normalized())
                            .toRotationMatrix();
      const Vec3 over = (turn * q).cwiseAbs() - shape.extent(turn);
      EXPECT_LE(over.maxCoeff(), 1e-14) << shape.name;
    }
  }
}

// What may slip between nodes is a part of the shape: neither a ball nor the side of a segment
// stands out.
TEST(Shapes, RodsLieInside) {
  std::uint64_t seed = 6000000;
  for (const Named& shape : shapes_of_all_kinds()) {
    for (const shapes::Rod& rod : shape.rods) {
      EXPECT_GT(rod.radius, 0.0) << shape.name;
      for (int i = 0; i < 100; ++i) {
        Vec3 out = somewhere(seed).normalized();
        const Vec3 along = rod.b - rod.a;
        if (rod.a != rod.b) out = out.cross(along).normalized();
        const Vec3 q = rod.a + random_number(seed++) * along + rod.radius * out;
        EXPECT_LE(shape.surface(q).distance, 1e-14) << shape.name;
      }
    }
  }
}

TEST(Shapes, AtTheCentreThereIsAFixedWayOut) {
  EXPECT_EQ(shapes::Sphere{2.0}.surface(Vec3::Zero()).normal, Vec3::UnitY());
  EXPECT_EQ(shapes::Sphere{2.0}.surface(Vec3::Zero()).distance, -2.0);
  EXPECT_EQ((shapes::Capsule{0.2, 0.5}.surface(Vec3(0, 0, 0.1)).nearest), Vec3(0, 0.2, 0.1));
  EXPECT_EQ(shapes::Box{Vec3(0.5, 0.2, 0.35)}.surface(Vec3::Zero()).nearest, Vec3(0, 0.2, 0));
}

// Gaps are measured from a fixed point, so that a node at rest that slides does not change its own.
TEST(Shapes, APlaneMeasuresGapsFromItsOrigin) {
  EXPECT_EQ(shapes::Plane{}.surface(Vec3(0.3, 0.1, 7.0)).anchor, Vec3::Zero());
  EXPECT_EQ(shapes::Sphere{1.0}.surface(Vec3(0, 3, 0)).anchor, Vec3(0, 1, 0));
}

}  // namespace
}  // namespace sinew
