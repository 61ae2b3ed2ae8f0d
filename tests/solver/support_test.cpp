#include "sinew/solver/support.h"

#include <gtest/gtest.h>

#include "sinew/base/error.h"
#include "sinew/forces/terms.h"
#include "tests/support/fields.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

Model free_box() {
  Model m = test::tissue_box(Material{}, {2, 2, 2});
  m.start_gravity = Vec3::Zero();
  finish(m);
  return m;
}

Support support_of(const Model& m) {
  const Controls controls = initial_controls(m);
  return find_support(m, controls, 0.0, outer_forces(m, controls, initial_state(m)));
}

TEST(Support, OfAFreeBodyIsNoneAndOfAPushedOneRefused) {
  Model m = free_box();
  m.start_gravity = Vec3(0, -9.81, 0);
  EXPECT_THROW(support_of(m), Error);
  m.start_gravity = Vec3::Zero();
  const Support support = support_of(m);
  EXPECT_TRUE(support.none);
  EXPECT_TRUE(support.on_planes.empty());
  EXPECT_FALSE(support.by_contact);
}

TEST(Support, DriftIsUndoneAndTheShapeKept) {
  const Model m = free_box();
  const Controls controls = initial_controls(m);
  const Mat3 stretch = 1.2 * Mat3::Identity();
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const std::vector<Vec3> deformed = test::mapped(m.rest_position, stretch);
  std::vector<Vec3> x = test::mapped(deformed, turn);
  for (Vec3& p : x) p += Vec3(0.3, -0.2, 0.1);
  undo_drift(m, controls, m.rest_position, x);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_LE((x[i] - deformed[i]).norm(), 1e-12);
}

TEST(Support, ALoadWithADirectionKeepsTheTurn) {
  Model m = free_box();
  Load load;
  load.nodes = {0};
  load.force = Vec3(1.0, 0.0, 0.0);
  m.loads.push_back(load);
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3::UnitY()).toRotationMatrix();
  const std::vector<Vec3> turned = test::mapped(m.rest_position, turn);
  std::vector<Vec3> x = turned;
  undo_drift(m, initial_controls(m), m.rest_position, x);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_LE((x[i] - turned[i]).norm(), 1e-12);
}

}  // namespace
}  // namespace sinew
