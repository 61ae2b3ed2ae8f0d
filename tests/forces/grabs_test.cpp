#include "sinew/forces/grabs.h"

#include <gtest/gtest.h>

#include "sinew/base/random.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

Model held_box() {
  Model m = test::tissue_box({}, {2, 2, 2});
  m.pins.push_back({"base", test::nodes_at(m, 1, -0.05), {}});
  finish(m);
  m.start_gravity = Vec3::Zero();
  return m;
}

// Gravity stays off.
Controls grabbing_hand(const Model& m) {
  Grab grab{{1, 13, 26}, {5.0, 20.0, 7.0}, {}, Vec3(0.1, 0.2, -0.1)};
  for (const Index node : grab.nodes) grab.offset.push_back(0.5 * m.rest_position[uz(node)]);
  return {m.start_gravity, {grab}};
}

TEST(Grabs, ForceIsTheNegativeGradientOfTheEnergyAndStiffnessThatOfTheForce) {
  const Model m = held_box();
  const Controls controls = grabbing_hand(m);
  std::vector<Vec3> x = m.rest_position;
  const std::size_t n = x.size();
  std::vector<Vec3> u(n, Vec3::Zero());
  for (std::size_t i = 0; i < n; ++i) {
    if (m.inverse_mass[i] > 0.0) u[i] = random_point(i) - Vec3::Constant(0.5);
  }
  std::vector<Vec3> f(n, Vec3::Zero()), change(n, Vec3::Zero());
  add_grab_forces(m, controls, x, f);
  add_grab_stiffness_times(m, controls, 1.0, u, change);
  const double h = 1e-6;
  std::vector<Vec3> ahead = x, behind = x;
  double along = 0.0, bend = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    ahead[i] += h * u[i];
    behind[i] -= h * u[i];
    along += f[i].dot(u[i]);
    bend += change[i].dot(u[i]);
  }
  EXPECT_NEAR((grab_energy(m, controls, behind) - grab_energy(m, controls, ahead)) / (2 * h), along,
              1e-7);
  std::vector<Vec3> f_ahead(n, Vec3::Zero());
  add_grab_forces(m, controls, ahead, f_ahead);
  double fall = 0.0;
  for (std::size_t i = 0; i < n; ++i) fall += (f[i] - f_ahead[i]).dot(u[i]) / h;
  EXPECT_NEAR(fall, bend, 1e-6);
}

}  // namespace
}  // namespace sinew
