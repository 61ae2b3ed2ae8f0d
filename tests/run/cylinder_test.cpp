// A cylinder as an obstacle: bodies that rest on its end and its rim, and rollers that carry one.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "sinew/scene/build.h"
#include "sinew/sim/stepping.h"

namespace sinew {
namespace {

// A run to its end, and the mean position of its only body there.
struct Ran {
  RunState run;
  Vec3 mean = Vec3::Zero();
  double lowest = no_limit;  // node of the body [m]
};

Ran run_text(const std::string& text) {
  const Scene scene = parse_scene(text, "cylinder.toml", ".");
  const Model model = build_model(scene);
  Ran out;
  out.run.state = initial_state(model);
  const Controls controls = initial_controls(model);
  Stepping stepping(scene, model, controls, out.run);
  while (out.run.frame < stepping.frame_count()) stepping.advance_frame(controls, out.run, nullptr);
  for (Index i = 0; i < model.body_node_count(); ++i) {
    out.mean += out.run.state.position[uz(i)] / model.body_node_count();
    out.lowest = std::min(out.lowest, out.run.state.position[uz(i)].y());
  }
  return out;
}

const std::string cube =
    "duration = 1\n[body.cube]\nshape = \"box\"\nsize = [0.1, 0.1, 0.1]\ncells = [2, 2, 2]\n"
    "position = [0, 0.052, 0]\nyoung = 50e3\ndamping_ratio = 0.5\n";

// The top of the cylinder is the plane y = 0.
std::string post(double radius) {
  return "[obstacle.post]\nshape = \"cylinder\"\nradius = " + std::to_string(radius) +
         "\nlength = 0.05\naxis = [0, 1, 0]\ncenter = [0, -0.025, 0]\n";
}

TEST(Cylinder, ACubeRestsOnItsEnd) {
  for (const char* stepper : {"verlet", "implicit"}) {
    const Ran ran = run_text("stepper = \"" + std::string(stepper) + "\"\n" + cube + post(0.08));
    EXPECT_NEAR(ran.lowest, 0.0, 1e-5) << stepper;
    EXPECT_LT(ran.mean.head<1>().norm(), 1e-4) << stepper;
    EXPECT_GT(ran.run.contacts, 0) << stepper;
  }
}

// Of the nodes of its lower side only the middle one is over the cylinder: the rim holds the rest.
TEST(Cylinder, ACubeRestsOnItsRimBetweenItsNodes) {
  const Ran ran = run_text(cube + post(0.03));
  EXPECT_GT(ran.lowest, -2e-3);
  EXPECT_LT(ran.run.deepest, 1e-4);
  EXPECT_LT(std::max(std::abs(ran.mean.x()), std::abs(ran.mean.z())), 1e-3);
}

TEST(Cylinder, RollersCarryASlab) {
  std::string text =
      "duration = 0.6\n[body.slab]\nshape = \"box\"\nsize = [0.3, 0.03, 0.1]\ncells = [12, 2, 4]\n"
      "position = [-0.02, 0.0451, 0]\nyoung = 200e3\ndamping_ratio = 0.5\n";
  for (const char* roller : {"left", "right"}) {
    text += "[obstacle." + std::string(roller) +
            "]\nshape = \"cylinder\"\nradius = 0.03\nlength = 0.2\ncenter = [" +
            (roller[0] == 'l' ? "-0.08" : "0.08") +
            ", 0, 0]\nfriction = 0.8\npath = [{ time = 1, turn = [0, 0, -90] }]\n";
  }
  const Ran ran = run_text(text);
  const double speed = 0.5 * M_PI * 0.03;  // of the rollers' surface [m/s]
  EXPECT_NEAR(ran.mean.x() + 0.02, 0.6 * speed, 0.05 * 0.6 * speed);
  EXPECT_NEAR(ran.mean.y(), 0.045, 2e-3);  // it sags between them
}

}  // namespace
}  // namespace sinew
