#include "sinew/identify/calibrate.h"

#include <gtest/gtest.h>

#include "sinew/base/error.h"
#include "sinew/identify/moduli.h"
#include "sinew/mesh/shapes.h"
#include "tests/identify/support.h"
#include "tests/support/effort.h"

namespace sinew {
namespace {

using test::body_of;

TEST(Calibrate, MatchesYoungAndPoissonOnThisMesh) {
  for (const TetMesh& mesh : {box(Vec3(0.1, 0.1, 0.1), {4, 4, 4}, 0.3), sphere(0.05, 4)}) {
    for (const double poisson : {0.35, 0.45}) {
      if (test::sanitized && poisson < 0.4) continue;
      Material material;
      material.law = Law::calibrated;
      material.young = 9e3;
      material.poisson = poisson;
      BodySpec body = body_of(mesh, material);
      calibrate_materials(body);
      const Moduli m = moduli_of(measure_stiffness(body, TestKind::traction));
      EXPECT_NEAR(m.young, 9e3, 1e-4 * 9e3);
      EXPECT_NEAR(m.poisson, poisson, 1e-4);
    }
  }
}

TEST(Calibrate, RefusesWhatSpringsCannotHave) {
  EXPECT_THROW(calibrate(box(Vec3(0.1, 0.1, 0.1), {3, 3, 3}), 0.1), Error);
}

}  // namespace
}  // namespace sinew
