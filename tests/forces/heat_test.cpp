#include "sinew/forces/heat.h"

#include <gtest/gtest.h>

#include "tests/support/fields.h"
#include "tests/support/forces.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

TEST(Heat, IsThePowerOfAllDampingForcesAndSymmetric) {
  Material material;
  material.viscosity = 20.0;
  material.drag = 3.0;
  material.damping_ratio = 0.2;
  Model m = test::tissue_box(material, {2, 2, 2});
  finish(m);
  State s = initial_state(m);
  s.position = test::shaken(m.rest_position, 0.005);
  const std::vector<Vec3> v = test::scattered(s.position.size(), 1.0, 50);
  const std::vector<Vec3> u = test::scattered(s.position.size(), 1.0, 51);
  const std::vector<Vec3> still = test::forces_at(m, initial_controls(m), s).force;
  s.half_velocity = v;
  const NodalForces moving = test::forces_at(m, initial_controls(m), s);
  const double heat = damping_power(m, s.position, v, v);
  EXPECT_NEAR(heat, moving.heat, 1e-9 * heat);
  double power = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i) power -= (moving.force[i] - still[i]).dot(u[i]);
  EXPECT_NEAR(damping_power(m, s.position, v, u), power, 1e-9 * heat);
  EXPECT_NEAR(damping_power(m, s.position, u, v), power, 1e-9 * heat);
}

}  // namespace
}  // namespace sinew
