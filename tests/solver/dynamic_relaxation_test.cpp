// Rest states that take too many Newton steps from where they start.
#include <gtest/gtest.h>

#include "sinew/solver/static.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

TEST(DynamicRelaxation, EndsAtTheSameRestState) {
  Material material;
  material.young = 2e3;
  Model m = test::tissue_box(material, {6, 2, 2}, Vec3(0.3, 0.05, 0.05));
  m.pins.push_back({"end", test::nodes_at(m, 0, -0.15), {}});
  finish(m);
  const Controls controls = initial_controls(m);
  State expected = initial_state(m);
  StaticSolver(m).solve(controls, 1.0, {}, expected);

  State found = initial_state(m);
  StaticOptions hurried;
  hurried.max_newton = 3;  // far too few: the load is cut twice, then the body falls to rest
  const StepReport report = StaticSolver(m).solve(controls, 1.0, hurried, found);
  EXPECT_LE(report.residual, hurried.tolerance);
  EXPECT_EQ(report.load_steps, 2);  // both fail, and none comes after the fall
  double displacement = 0.0, error = 0.0;
  for (std::size_t i = 0; i < found.position.size(); ++i) {
    displacement = std::max(displacement, (expected.position[i] - m.rest_position[i]).norm());
    error = std::max(error, (found.position[i] - expected.position[i]).norm());
  }
  EXPECT_GT(displacement, 0.05);
  EXPECT_LT(error, 1e-4 * displacement);
}

}  // namespace
}  // namespace sinew
