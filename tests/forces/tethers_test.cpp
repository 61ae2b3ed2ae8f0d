#include "sinew/forces/tethers.h"

#include <gtest/gtest.h>

#include "sinew/base/random.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

Model tethered_box() {
  Model m = test::tissue_box({}, {2, 2, 2});
  m.pins.push_back({"base", test::nodes_at(m, 1, -0.05), {}});
  finish(m);
  m.gravity = Vec3::Zero();
  Tether tether{{1, 13, 26}, {5.0, 20.0, 7.0}, {}, Vec3(0.1, 0.2, -0.1)};
  for (const Index node : tether.nodes) tether.offset.push_back(0.5 * m.rest_position[uz(node)]);
  m.tethers.push_back(tether);
  return m;
}

TEST(Tethers, ForceIsTheNegativeGradientOfTheEnergyAndStiffnessThatOfTheForce) {
  const Model m = tethered_box();
  std::vector<Vec3> x = m.rest_position;
  const std::size_t n = x.size();
  std::vector<Vec3> u(n, Vec3::Zero());
  for (std::size_t i = 0; i < n; ++i) {
    if (m.inverse_mass[i] > 0.0) u[i] = random_point(i) - Vec3::Constant(0.5);
  }
  std::vector<Vec3> f(n, Vec3::Zero()), change(n, Vec3::Zero());
  add_tether_forces(m, x, f);
  add_tether_stiffness_times(m, 1.0, u, change);
  const double h = 1e-6;
  std::vector<Vec3> ahead = x, behind = x;
  double along = 0.0, bend = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    ahead[i] += h * u[i];
    behind[i] -= h * u[i];
    along += f[i].dot(u[i]);
    bend += change[i].dot(u[i]);
  }
  EXPECT_NEAR((tether_energy(m, behind) - tether_energy(m, ahead)) / (2 * h), along, 1e-7);
  std::vector<Vec3> f_ahead(n, Vec3::Zero());
  add_tether_forces(m, ahead, f_ahead);
  double fall = 0.0;
  for (std::size_t i = 0; i < n; ++i) fall += (f[i] - f_ahead[i]).dot(u[i]) / h;
  EXPECT_NEAR(fall, bend, 1e-6);
}

}  // namespace
}  // namespace sinew
