// All steppers behind one interface.
#include "sinew/solver/stepper.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "sinew/base/error.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

// Held at its top.
Model hanging_box() {
  Model m = test::tissue_box(Material{}, {2, 2, 2});
  m.pins.push_back({"top", test::nodes_at(m, 1, 0.05), {}});
  finish(m);
  return m;
}

// What every stepper promises, whatever its method.
class EveryStepper : public testing::TestWithParam<StepperKind> {};

TEST_P(EveryStepper, TakesStepsFromTheSameStateToTheSameBits) {
  const Model m = hanging_box();
  const Controls controls = initial_controls(m);
  const auto run = [&] {
    const auto stepper = make_stepper(GetParam(), m, {});
    State state = initial_state(m);
    StepMemory memory;
    const FirstStep first = stepper->begin(controls, state, memory);
    const double h = 0.5 * std::min({first.stable, first.longest, 0.01});
    StepReport last;
    for (int i = 0; i < 3; ++i) {
      const auto stable = stepper->watch(h, controls, state, memory);
      EXPECT_GT(stable.value_or(no_limit), h);
      last = stepper->step(h, controls, {}, state, memory);
    }
    EXPECT_NEAR(state.time, 3 * h, 1e-12);
    EXPECT_EQ(state.step, 3);
    EXPECT_TRUE(last.limits_met);
    EXPECT_FALSE(last.stopped);
    EXPECT_EQ(last.cuts, 0);
    return state.hash();
  };
  EXPECT_EQ(run(), run());
}

// Every one that has a word: a new one is tested as it is named.
std::vector<StepperKind> all_steppers() {
  std::vector<StepperKind> kinds;
  for (const auto& entry : words_of(StepperKind{})) {
    if (entry.value != StepperKind::automatic) kinds.push_back(entry.value);
  }
  return kinds;
}

INSTANTIATE_TEST_SUITE_P(Steppers, EveryStepper, testing::ValuesIn(all_steppers()),
                         [](const auto& test) { return std::string(word_of(test.param)); });

TEST(Stepper, HasToBeChosenFirst) {
  const Model m = hanging_box();
  EXPECT_THROW(make_stepper(StepperKind::automatic, m, {}), Error);
}

}  // namespace
}  // namespace sinew
