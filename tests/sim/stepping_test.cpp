#include "sinew/sim/stepping.h"

#include <gtest/gtest.h>

#include <limits>

#include "sinew/base/error.h"
#include "sinew/scene/build.h"

namespace sinew {
namespace {

RunState rest_run(const Model& model) {
  RunState run;
  run.state = initial_state(model);
  return run;
}

struct BoxRun {
  explicit BoxRun(const std::string& stepper)
      : scene(parse_scene("duration = 0.1\nstepper = \"" + stepper +
                              "\"\n[body.box]\nshape = \"box\"\ncells = [2, 2, 2]\n",
                          "box.toml", {})),
        model(build_model(scene)),
        controls(initial_controls(model)),
        run(rest_run(model)),
        stepping(scene, model, controls, run) {}

  Scene scene;
  Model model;
  Controls controls;
  RunState run;
  Stepping stepping;
};

ErrorKind kind_of_step(BoxRun& r) {
  try {
    r.stepping.step(r.controls, r.run);
  } catch (const Error& error) {
    return error.kind();
  }
  return ErrorKind::internal;
}

TEST(Stepping, AnAccountThatIsNotFiniteEndsTheRunInTheSameStep) {
  for (const std::string stepper : {"verlet", "implicit"}) {
    for (const double bad :
         {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
      BoxRun work(stepper), heat(stepper);
      work.run.state.energy.work_in = bad;
      EXPECT_EQ(kind_of_step(work), ErrorKind::diverged) << stepper;
      heat.run.state.energy.dissipated = bad;
      EXPECT_EQ(kind_of_step(heat), ErrorKind::diverged) << stepper;
    }
  }
}

TEST(Stepping, PositionsThatAreNotFiniteEndTheRun) {
  for (const std::string stepper : {"verlet", "implicit"}) {
    BoxRun r(stepper);
    r.run.state.position[3].x() = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(kind_of_step(r), ErrorKind::diverged) << stepper;
  }
}

}  // namespace
}  // namespace sinew
