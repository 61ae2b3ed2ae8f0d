#include "sinew/forces/springs.h"

#include <gtest/gtest.h>

#include "sinew/forces/assemble.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

// Node 1, of 2 kg, on a spring of 50 N/m with a dashpot of 3 N s/m, 0.1 m too long at 2 m/s.
TEST(Springs, ForceHeatAndEnergyByHand) {
  const Model m = test::oscillator(3.0, 1.1);
  State s = initial_state(m);
  s.half_velocity[1] = Vec3(2.0, 0.0, 0.0);
  std::vector<Vec3> force;
  EXPECT_NEAR(compute_spring_forces(m, s, force), 3.0 * 4.0, 1e-12);
  const Vec3 expected(50.0 * 0.1 + 3.0 * 2.0, 0.0, 0.0);  // on end 0
  EXPECT_LT((gather_springs(m, force, 0) - expected).norm(), 1e-12);
  EXPECT_LT((gather_springs(m, force, 1) + expected).norm(), 1e-12);
  EXPECT_NEAR(spring_energy(m, s.position), 0.5 * 50.0 * 0.01, 1e-12);
}

TEST(Springs, StretchIsThatOfTheBodiesOwnSprings) {
  Material material;
  material.law = Law::lloyd;
  Model m = test::tissue_box(material, {2, 2, 2});
  add_attachment(m, 0, 26, 30.0, 0.0, 0.01);  // far from its rest length, and of no body
  finish(m);
  EXPECT_LT(measure_stretch(m, m.rest_position).stretch, 1e-12);
  std::vector<Vec3> x = m.rest_position;
  for (Vec3& p : x) p = Vec3(1.25 * p.x(), 0.5 * p.y(), p.z());
  const StretchRange range = measure_stretch(m, x);
  EXPECT_NEAR(range.stretch, 0.25, 1e-12);
  EXPECT_NEAR(range.compress, 0.5, 1e-12);
  EXPECT_LT(range.longest, m.first_attachment);
}

}  // namespace
}  // namespace sinew
