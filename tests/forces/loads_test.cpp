#include "sinew/forces/loads.h"

#include <gtest/gtest.h>

#include <numbers>

#include "sinew/base/random.h"
#include "sinew/mesh/surface.h"
#include "tests/support/models.h"
#include "tests/support/terms.h"

namespace sinew {
namespace {

// The whole surface of a box, or its side x = 0.05, as the faces of a load.
Load area_load(const Model& m, bool closed) {
  Load load;
  load.name = "press";
  for (const Triangle& t : build_surface(m.tets, m.node_count()).triangles) {
    bool chosen = true;
    for (const Index corner : t)
      chosen = chosen && (closed || std::abs(m.rest_position[uz(corner)].x() - 0.05) < 1e-9);
    if (!chosen) continue;
    load.faces.push_back(t);
    load.rest_area.push_back(area_vector(m.rest_position, t).norm());
  }
  return load;
}

Model box_with(const Load& load, std::vector<Index> pinned = {}) {
  Model m = test::tissue_box({}, {3, 2, 2});
  if (!pinned.empty()) m.pins = {{"held", std::move(pinned), {}}};
  m.loads = {load};
  finish(m);
  return m;
}

std::vector<Vec3> distorted(const Model& m) {
  std::vector<Vec3> x = m.rest_position;
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += 0.01 * random_point(i);
  return x;
}

std::vector<Vec3> forces_at(const Model& m, const std::vector<Vec3>& x, double time) {
  std::vector<Vec3> f(x.size(), Vec3::Zero());
  LoadTerm::add_forces(test::at(m, x, time), f);
  return f;
}

// Forces against central differences of the potential, at free nodes.
void expect_gradient(const Model& m, double time) {
  std::vector<Vec3> x = distorted(m);
  const std::vector<Vec3> f = forces_at(m, x, time);
  double largest = 0.0;
  for (const Vec3& v : f) largest = std::max(largest, v.norm());
  ASSERT_GT(largest, 0.0);
  const double h = 1e-6;
  for (Index i = 0; i < m.node_count(); ++i) {
    if (m.inverse_mass[uz(i)] == 0.0) {
      EXPECT_EQ(f[uz(i)], Vec3::Zero());
      continue;
    }
    for (int c = 0; c < 3; ++c) {
      const double at = x[uz(i)][c];
      x[uz(i)][c] = at + h;
      const double up = LoadTerm::energy(test::at(m, x, time));
      x[uz(i)][c] = at - h;
      const double down = LoadTerm::energy(test::at(m, x, time));
      x[uz(i)][c] = at;
      EXPECT_NEAR(-(up - down) / (2 * h), f[uz(i)][c], 1e-7 * largest);
    }
  }
}

TEST(Loads, ForceIsTheNegativeGradientOfThePotential) {
  const Model plain = test::tissue_box({}, {3, 2, 2});
  Load nodal{"push", {0, 3, 5}, Vec3(1, -2, 3), 0.0, no_limit, 2.0};
  expect_gradient(box_with(nodal), 0.5);

  Load traction = area_load(plain, false);
  traction.traction = Vec3(10, 20, -30);
  expect_gradient(box_with(traction), 0.0);

  Load pressure = area_load(plain, true);
  pressure.pressure = 1e3;
  expect_gradient(box_with(pressure), 0.0);
}

TEST(Loads, PressureOnAnOpenPatchHasItsPotentialWhereTheRimIsPinned) {
  const Model plain = test::tissue_box({}, {3, 2, 2});
  Load pressure = area_load(plain, false);
  pressure.pressure = 1e3;
  std::vector<Index> rim;
  for (Index i = 0; i < plain.node_count(); ++i) {
    const Vec3& X = plain.rest_position[uz(i)];
    if (std::abs(X.x() - 0.05) < 1e-9 && X.tail<2>().cwiseAbs().maxCoeff() > 0.049)
      rim.push_back(i);
  }
  ASSERT_EQ(rim.size(), 8U);  // of 9: one is free
  expect_gradient(box_with(pressure, rim), 0.0);
}

TEST(Loads, TractionAddsUpToItselfTimesTheArea) {
  Load load = area_load(test::tissue_box({}, {3, 2, 2}), false);
  load.traction = Vec3(0, 500, -100);
  const Model m = box_with(load);
  Vec3 sum = Vec3::Zero();
  for (const Vec3& f : forces_at(m, distorted(m), 0.0)) sum += f;
  EXPECT_LT((sum - Vec3(0, 5, -1)).norm(), 1e-12);
}

TEST(Loads, PressurePushesInwardsAndFollowsTheSurface) {
  Load load = area_load(test::tissue_box({}, {3, 2, 2}), false);
  load.pressure = 2e3;
  const Model m = box_with(load);
  Vec3 sum = Vec3::Zero();
  for (const Vec3& f : forces_at(m, m.rest_position, 0.0)) sum += f;
  EXPECT_LT((sum - Vec3(-20, 0, 0)).norm(), 1e-12);

  // Turned by 90 degrees about z and stretched twofold along z: along -y now, on twice the area.
  std::vector<Vec3> x = m.rest_position;
  for (Vec3& p : x) p = Vec3(-p.y(), p.x(), 2 * p.z());
  sum = Vec3::Zero();
  for (const Vec3& f : forces_at(m, x, 0.0)) sum += f;
  EXPECT_LT((sum - Vec3(0, -40, 0)).norm(), 1e-12);
}

TEST(Loads, PressureOnAClosedSurfaceHasNeitherForceNorMoment) {
  Load load = area_load(test::tissue_box({}, {3, 2, 2}), true);
  load.pressure = 1e3;
  const Model m = box_with(load);
  const std::vector<Vec3> x = distorted(m);
  const std::vector<Vec3> f = forces_at(m, x, 0.0);
  Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
  for (std::size_t i = 0; i < x.size(); ++i) {
    sum += f[i];
    moment += x[i].cross(f[i]);
  }
  EXPECT_LT(sum.norm(), 1e-12);
  EXPECT_LT(moment.norm(), 1e-12);
}

}  // namespace
}  // namespace sinew
