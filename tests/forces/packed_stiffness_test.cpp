#include "sinew/forces/packed_stiffness.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sinew/forces/packed.h"
#include "sinew/forces/stiffness.h"
#include "tests/support/fields.h"
#include "tests/support/forces.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

using test::norm;

// |packed - plain| / |plain| of (a K + b C) u for a wave of the length of an edge.
double mismatch(const Model& m, const std::vector<Vec3>& x, double a, double b) {
  std::vector<Vec3> u(x.size()), plain(x.size()), packed(x.size());
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double t = static_cast<double>(i);
    if (m.inverse_mass[i] > 0.0) u[i] = Vec3(std::sin(t), std::sin(1.7 * t), std::cos(2.3 * t));
  }
  test::tangent_times({m, initial_controls(m), x}, a, b, u, Tangent::only_stiffening, plain);
  const Controls controls = initial_controls(m);
  ForceEvaluator forces(m, Precision::single);
  auto product = forces.packed_products(controls, x);
  if (!product) return 1.0;
  product->times(a, b, u, packed);
  const double size = norm(plain);
  for (std::size_t i = 0; i < u.size(); ++i) packed[i] -= plain[i];
  return norm(packed) / size;
}

std::vector<Vec3> bent(const Model& m) {
  std::vector<Vec3> x = m.rest_position;
  for (Vec3& p : x) p += Vec3(0.2 * p.z() * p.z(), 0.1 * p.x(), -0.15 * p.x() * p.z());
  return x;
}

TEST(PackedStiffness, IsThePlainProduct) {
  for (const double poisson : {0.3, 0.45, 0.49}) {
    Material material;
    material.poisson = poisson;
    material.damping_ratio = 0.5;
    material.drag = 3.0;
    Model m = test::tissue_box(material, {4, 4, 4});
    finish(m);
    for (const auto& x : {m.rest_position, bent(m)}) {
      EXPECT_LT(mismatch(m, x, 1.0, 0.0), 3e-3) << poisson;
      EXPECT_LT(mismatch(m, x, 0.0, 1.0), 1e-3) << poisson;
      EXPECT_LT(mismatch(m, x, 1e-7, 2e-4), 3e-3) << poisson;
    }
  }
}

TEST(PackedStiffness, KnowsViscosity) {
  Material material;
  material.viscosity = 20.0;
  Model m = test::tissue_box(material, {3, 3, 3});
  finish(m);
  EXPECT_LT(mismatch(m, bent(m), 1e-7, 2e-4), 3e-3);
}

TEST(PackedStiffness, IsThePlainProductOfTetsPressedFlatAndInsideOut) {
  Material material;
  material.damping_ratio = 0.5;
  Model m = test::tissue_box(material, {4, 4, 4});
  finish(m);
  for (const auto& [pressed, most] :
       {std::pair{0.45, 3e-3}, {0.1, 3e-3}, {0.01, 2e-2}, {-0.2, 3e-3}}) {
    std::vector<Vec3> x = bent(m);
    for (Vec3& p : x) p.y() *= pressed;
    EXPECT_LT(mismatch(m, x, 1e-7, 2e-4), most) << pressed;
  }
}

TEST(PackedStiffness, LeavesClassicSpringsToThePlainProduct) {
  Material material;
  material.law = Law::lloyd;
  Model springs = test::tissue_box(material, {2, 2, 2});
  finish(springs);
  const auto has_packed = [](const Model& m, Precision precision) {
    const Controls controls = initial_controls(m);
    ForceEvaluator forces(m, precision);
    return forces.packed_products(controls, m.rest_position).has_value();
  };
  EXPECT_FALSE(has_packed(springs, Precision::single));
  Model m = test::tissue_box(Material{}, {2, 2, 2});
  finish(m);
  EXPECT_FALSE(has_packed(m, Precision::double_));
  EXPECT_TRUE(has_packed(m, Precision::single));
}

TEST(PackedStiffness, OfNoMotionIsZero) {
  Model m = test::tissue_box(Material{}, {2, 2, 2});
  finish(m);
  const std::vector<Vec3> u(m.rest_position.size(), Vec3::Zero());
  std::vector<Vec3> out(u.size(), Vec3::Ones());
  const Controls controls = initial_controls(m);
  ForceEvaluator forces(m, Precision::single);
  forces.packed_products(controls, m.rest_position)->times(1.0, 1.0, u, out);
  EXPECT_EQ(norm(out), 0.0);
}

}  // namespace
}  // namespace sinew
