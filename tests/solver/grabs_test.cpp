#include "sinew/forces/grabs.h"

#include <gtest/gtest.h>

#include "sinew/solver/implicit.h"
#include "sinew/solver/verlet.h"
#include "tests/support/effort.h"
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
  Controls controls = initial_controls(m);
  controls.grabs = {grab};
  return controls;
}

TEST(Grabs, VerletAndImplicitStepsCarryABodyToTheSameRest) {
  if (test::sanitized) return;  // thousands of steps of what the live view's tests run, too
  const Model m = held_box();
  const Controls controls = grabbing_hand(m);
  const auto settled = [&](bool implicit) {
    State state = initial_state(m);
    if (implicit) {
      ImplicitStepper stepper(m);
      ImplicitOptions options;
      options.scheme = Scheme::backward_euler;
      for (int i = 0; i < 200; ++i) stepper.step(0.05, controls, options, state);
    } else {
      VerletStepper verlet(m, Precision::double_);
      for (int i = 0; i < 12000; ++i) verlet.step(1e-3, controls, state);
    }
    return state;
  };
  const State a = settled(false);
  const State b = settled(true);
  for (std::size_t i = 0; i < a.position.size(); ++i) {
    EXPECT_LT((a.position[i] - b.position[i]).norm(), 1e-4) << i;
  }
  // It moved, and is held back.
  EXPECT_GT((b.position[26] - m.rest_position[26]).norm(), 1e-3);
  EXPECT_GT(grab_force(m, controls.grabs[0], b.position).norm(), 0.1);
}

}  // namespace
}  // namespace sinew
