#include "sinew/forces/inversion_recovery.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sinew/base/random.h"
#include "sinew/forces/terms.h"
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
  Workspace workspace(m);
  State state = initial_state(m);
  compute_forces(m, initial_controls(m), state, workspace);
  EXPECT_EQ(find_tangled(m, workspace), 0);
  state.position[0] = Vec3::Zero();  // a corner pushed through its own tets, not through others
  compute_forces(m, initial_controls(m), state, workspace);
  EXPECT_EQ(find_tangled(m, workspace), 0);
  for (Vec3& x : state.position) x.z() = 0.0;
  compute_forces(m, initial_controls(m), state, workspace);
  EXPECT_EQ(find_tangled(m, workspace), 1);
  EXPECT_EQ(workspace.tangled[0], 1);
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
  Workspace workspace(m);
  State state = initial_state(m);
  for (std::size_t i = 0; i < state.position.size(); ++i) state.position[i] = random_point(i);
  compute_forces(m, initial_controls(m), state, workspace);
  ASSERT_EQ(find_tangled(m, workspace), 1);
  right_tangled_bodies(m, state, 1e-4, workspace);
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  double size = 0.0;
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    force += workspace.force[i];
    torque += state.position[i].cross(workspace.force[i]);
    size += workspace.force[i].norm();
  }
  EXPECT_LE(force.norm(), 1e-9 * size);
  EXPECT_LE(torque.norm(), 1e-9 * size);
}

// Thrown apart much faster than its waves run, it stays together: nothing leaves by more than
// about its size.
TEST(InversionRecovery, WhatFliesApartIsCaught) {
  Model m = free_box();
  for (double& modulus : m.tet_modulus) modulus *= 1e-6;
  const double size = std::cbrt(m.bodies[0].rest_volume);
  Workspace workspace(m);
  State state = initial_state(m);
  for (Vec3& x : state.position) x.z() = -x.z();  // inside out
  const double speed = 100.0;                     // [m/s], of sizes of centimetres
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    state.half_velocity[i] = speed * (random_point(i) - Vec3::Constant(0.5));
  }
  const double h = 0.01 * size / speed;
  double farthest = 0.0;
  for (int step = 0; step < 500; ++step) {
    workspace.tangled = {1};
    std::fill(workspace.force.begin(), workspace.force.end(), Vec3::Zero());
    compute_forces(m, initial_controls(m), state, workspace);
    workspace.tangled = {1};
    right_tangled_bodies(m, state, h, workspace);
    const std::vector<Vec3> goal = rest_shape_at(m, m.bodies[0], state.position);
    for (std::size_t i = 0; i < state.position.size(); ++i) {
      if (step > 100) farthest = std::max(farthest, (state.position[i] - goal[i]).norm());
      state.half_velocity[i] += h * m.inverse_mass[i] * workspace.force[i];
      state.position[i] += h * state.half_velocity[i];
    }
  }
  EXPECT_LT(farthest, 2.0 * size);
}

}  // namespace
}  // namespace sinew
