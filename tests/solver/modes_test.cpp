#include "sinew/solver/modes.h"

#include <gtest/gtest.h>

#include "sinew/base/error.h"
#include "sinew/forces/assemble.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

// 2 kg between three springs at rest, one along each axis: omega = sqrt(k / m).
TEST(Modes, OfAMassBetweenThreeSpringsByHand) {
  Model m = test::point_masses(
      {{Vec3::Zero(), 2.0}, {Vec3::UnitX(), 0.0}, {Vec3::UnitY(), 0.0}, {Vec3::UnitZ(), 0.0}});
  add_attachment(m, 0, 1, 200.0, 0.0, 1.0);
  add_attachment(m, 0, 2, 50.0, 0.0, 1.0);
  add_attachment(m, 0, 3, 450.0, 0.0, 1.0);
  finish(m);
  const Modes modes = lowest_modes(m, m.rest_position, 3);
  EXPECT_TRUE(modes.converged);
  ASSERT_EQ(modes.omega.size(), 3U);
  EXPECT_NEAR(modes.omega[0], 5.0, 1e-5);
  EXPECT_NEAR(modes.omega[1], 10.0, 1e-5);
  EXPECT_NEAR(modes.omega[2], 15.0, 1e-5);
  // Of unit mass-weighted norm, and all of the mass moves along its spring.
  EXPECT_NEAR(2.0 * modes.shape[0][0].squaredNorm(), 1.0, 1e-9);
  EXPECT_NEAR(modes.participation[0].y(), 1.0, 1e-6);
  EXPECT_NEAR(modes.participation[1].x(), 1.0, 1e-6);
  EXPECT_NEAR(modes.participation[2].z(), 1.0, 1e-6);
}

TEST(Modes, NeedABodyThatIsHeld) {
  Model m = test::tissue_box(Material{}, {2, 2, 2});
  finish(m);
  try {
    lowest_modes(m, m.rest_position, 1);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
  }
}

}  // namespace
}  // namespace sinew
