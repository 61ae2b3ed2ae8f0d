// Contacts that were lost once: in tests/data/contact/ a contact with an obstacle counted as found
// where any node touched the same obstacle, and real ones were skipped.
#include <gtest/gtest.h>

#include <string>

#include "sinew/scene/build.h"
#include "sinew/sim/stepping.h"
#include "tests/support/source_dir.h"

namespace sinew {
namespace {

RunState run_case(const std::string& name, double* rest_depth = nullptr) {
  const Scene scene = load_scene(test::source_path("tests/data/contact/" + name + ".toml"), {});
  const Model model = build_model(scene);
  RunState run;
  run.state = initial_state(model);
  const Controls controls = initial_controls(model);
  Stepping stepping(scene, model, controls, run);
  while (run.frame < stepping.frame_count()) {
    stepping.advance_frame(controls, run, nullptr);
    if (rest_depth != nullptr && run.state.time > 0.8 * scene.duration)
      *rest_depth = std::max(*rest_depth, run.depth);
  }
  return run;
}

TEST(LostContacts, APlaneHoldsABodyAsTheGroundDoes) {
  double rest = 0.0;
  const RunState plane = run_case("plane", &rest);
  const RunState ground = run_case("ground");
  EXPECT_EQ(plane.state.hash(), ground.state.hash());
  EXPECT_LT(plane.deepest, 1e-9);
  EXPECT_LT(rest, 1e-9);
  EXPECT_GT(plane.contacts, 0);
}

TEST(LostContacts, AFineBoxThatRollsStaysOnThePlane) {
  double rest = 0.0;
  const RunState run = run_case("mesh2", &rest);
  EXPECT_LT(run.deepest, 1e-9);
  EXPECT_LT(rest, 1e-9);
}

TEST(LostContacts, ABoxThatSlidesOnABoxStaysOutside) {
  double rest = 0.0;
  const RunState run = run_case("sphere_box", &rest);
  EXPECT_LT(run.deepest, 2e-4);
  EXPECT_LT(rest, 2e-5);  // it comes to lean over the edge, on rods between its nodes
}

}  // namespace
}  // namespace sinew
