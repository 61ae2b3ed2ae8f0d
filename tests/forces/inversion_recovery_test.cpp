#include "sinew/forces/inversion_recovery.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sinew/base/random.h"
#include "sinew/forces/terms.h"
#include "tests/support/forces.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

Model free_box() {
  Model m = test::tissue_box(Material{}, {3, 3, 3});
  m.start_gravity = Vec3::Zero();
  finish(m);
  return m;
}

TEST(InversionRecovery, ABodyIsTangledWhenManyTetsAreInsideOut) {
  const Model m = free_box();
  State state = initial_state(m);
  EXPECT_TRUE(find_tangled(m, find_low_tets(m, state.position)).empty());
  state.position[0] = Vec3::Zero();  // a corner pushed through its own tets, not through others
  EXPECT_TRUE(find_tangled(m, find_low_tets(m, state.position)).empty());
  for (Vec3& x : state.position) x.z() = 0.0;
  EXPECT_EQ(find_tangled(m, find_low_tets(m, state.position)), std::vector<Index>{0});
}

TEST(InversionRecovery, TheRestShapeGoesWhereTheBodyIs) {
  const Model m = free_box();
  const Mat3 turn = Eigen::AngleAxisd(2.0, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  std::vector<Vec3> moved, mirrored;
  for (const Vec3& X : m.rest_position) {
    moved.push_back(turn * X + Vec3(1, 2, 3));
    mirrored.push_back(Vec3(-X.x(), X.y(), X.z()));
  }
  const std::vector<Vec3> same = rest_shape_at(m, m.bodies[0], moved);
  for (std::size_t i = 0; i < same.size(); ++i) EXPECT_LE((same[i] - moved[i]).norm(), 1e-12);
  const std::vector<Vec3> back = rest_shape_at(m, m.bodies[0], mirrored);
  Mat3 map = Mat3::Zero();
  for (std::size_t i = 0; i < back.size(); ++i) map += back[i] * m.rest_position[i].transpose();
  EXPECT_GT(map.determinant(), 0.0);  // a rotation, not the mirror image
}

TEST(InversionRecovery, TheForcesKeepMomentumAndAngularMomentum) {
  const Model m = free_box();
  State state = initial_state(m);
  for (std::size_t i = 0; i < state.position.size(); ++i) state.position[i] = random_point(i);
  const NodalForces found = test::forces_at(m, initial_controls(m), state);
  const std::vector<Index> tangled = find_tangled(m, found.low_tets);
  ASSERT_EQ(tangled.size(), 1U);
  const std::vector<Vec3> force = recovery_forces(m, state, 1e-4, tangled, found.force);
  Vec3 sum = Vec3::Zero(), torque = Vec3::Zero();
  double size = 0.0;
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    sum += force[i];
    torque += state.position[i].cross(force[i]);
    size += force[i].norm();
  }
  EXPECT_LE(sum.norm(), 1e-9 * size);
  EXPECT_LE(torque.norm(), 1e-9 * size);
}

// Thrown apart much faster than its waves run, it stays together: nothing leaves by more than
// about its size.
TEST(InversionRecovery, WhatFliesApartIsCaught) {
  Model m = free_box();
  for (double& modulus : m.tet_modulus) modulus *= 1e-6;
  const double size = std::cbrt(m.bodies[0].rest_volume);
  State state = initial_state(m);
  for (Vec3& x : state.position) x.z() = -x.z();  // inside out
  const double speed = 100.0;                     // [m/s], of sizes of centimetres
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    state.half_velocity[i] = speed * (random_point(i) - Vec3::Constant(0.5));
  }
  const double h = 0.01 * size / speed;
  double farthest = 0.0;
  ForceEvaluator forces(m, Precision::double_);
  for (int step = 0; step < 500; ++step) {
    const std::vector<Vec3> force = recovery_forces(
        m, state, h, std::vector<Index>{0}, forces.evaluate(initial_controls(m), state).force);
    const std::vector<Vec3> goal = rest_shape_at(m, m.bodies[0], state.position);
    for (std::size_t i = 0; i < state.position.size(); ++i) {
      if (step > 100) farthest = std::max(farthest, (state.position[i] - goal[i]).norm());
      state.half_velocity[i] += h * m.inverse_mass[i] * force[i];
      state.position[i] += h * state.half_velocity[i];
    }
  }
  EXPECT_LT(farthest, 2.0 * size);
}

}  // namespace
}  // namespace sinew
