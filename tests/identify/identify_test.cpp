#include "sinew/identify/identify.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sinew/base/error.h"
#include "sinew/mesh/shapes.h"

namespace sinew {
namespace {

const TetMesh& cube() {
  static const TetMesh mesh = box(Vec3(0.1, 0.1, 0.1), {2, 2, 2}, 0.2);
  return mesh;
}

AskedMaterial asked(double poisson) {
  AskedMaterial material;
  material.young = 10e3;
  material.poisson = poisson;
  return material;
}

TEST(Identify, TheNetworkLawHasTheGivenModuliAndAStep) {
  const LawIdentity law = identify_law(cube(), asked(0.4), "neo-hookean", false);
  EXPECT_EQ(law.law, "neo-hookean");
  EXPECT_TRUE(law.note.empty());
  EXPECT_NEAR(law.traction.young, 10e3, 1e-6 * 10e3);
  EXPECT_NEAR(law.displacement.poisson, 0.4, 1e-6);
  EXPECT_GT(law.stable_step, 0.0);
  EXPECT_TRUE(law.curve.stretch.empty());
}

TEST(Identify, TheCurveOfTheNetworkLawIsThatOfTheMaterial) {
  const LawIdentity law = identify_law(cube(), asked(0.4), "neo-hookean", true);
  ASSERT_FALSE(law.curve.stretch.empty());
  ASSERT_EQ(law.curve.stress.size(), law.curve.stretch.size());
  ASSERT_EQ(law.curve.expected.size(), law.curve.stretch.size());
  for (std::size_t i = 0; i < law.curve.stretch.size(); ++i) {
    if (std::isnan(law.curve.stress[i])) continue;  // no rest state found
    EXPECT_NEAR(law.curve.stress[i], law.curve.expected[i], 1e-3 * 10e3) << law.curve.stretch[i];
  }
}

TEST(Identify, ALawThatCannotHaveTheMaterialHasANote) {
  const LawIdentity law = identify_law(cube(), asked(0.05), "calibrated", false);
  EXPECT_FALSE(law.note.empty());
}

TEST(Identify, UnknownLawsAreRefused) {
  EXPECT_EQ(identifiable_laws().front(), "neo-hookean");
  EXPECT_THROW(identify_law(cube(), asked(0.4), "hooke", false), Error);
}

}  // namespace
}  // namespace sinew
