#include "sinew/forces/stress.h"

#include <gtest/gtest.h>

#include "sinew/forces/terms.h"
#include "sinew/model/controls.h"
#include "sinew/model/state.h"
#include "tests/support/fields.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

using test::mapped;

Mat3 a_deformation() {
  Mat3 F;
  F << 1.1, 0.2, -0.1, 0.05, 0.9, 0.1, 0.0, -0.15, 1.05;
  return F;
}

Model jittered_box(const Material& material) {
  BodySpec spec;
  spec.name = "box";
  spec.mesh = box(Vec3(0.1, 0.1, 0.1), {3, 3, 3}, 0.25);
  spec.materials = {material};
  spec.regions = {"all"};
  Model m;
  add_body(m, spec);
  finish(m);
  return m;
}

// sigma = mu/J F F^T + (-mu + (lambda + mu)(J - 1)) I, Smith, de Goes, Kim 2018.
TEST(Stress, OfAUniformDeformationIsThatOfTheMaterial) {
  const Mat3 F = a_deformation();
  const double J = F.determinant();
  for (const Volume volume : {Volume::node, Volume::tet}) {
    for (const double poisson : {-0.2, 0.0, 0.3, 0.499}) {
      Material material;
      material.volume = volume;
      material.poisson = poisson;
      const Model m = jittered_box(material);
      const double mu = material.young / (2.0 * (1.0 + poisson));
      const double lambda = 2.0 * mu * poisson / (1.0 - 2.0 * poisson);
      const Mat3 right =
          mu / J * F * F.transpose() + (-mu + (lambda + mu) * (J - 1.0)) * Mat3::Identity();
      for (const Mat3& s : measure_stress(m, mapped(m.rest_position, F)))
        EXPECT_LE((s - right).norm(), 1e-9 * right.norm());
      for (const Mat3& s : measure_stress(m, m.rest_position))
        EXPECT_LE(s.norm(), 1e-9 * material.young);
    }
  }
}

// The power of the stresses, sum_t v_t sigma_t : L, is the change of the elastic energy under
// x' = L x.
TEST(Stress, DoesTheWorkOfTheEnergyUnderEveryLaw) {
  const Mat3 F = a_deformation();
  Mat3 L;
  L << 0.3, -0.2, 0.5, 0.1, -0.4, 0.2, 0.6, 0.1, 0.2;
  for (const Law law : {Law::neo_hookean, Law::vangelder, Law::lloyd, Law::calibrated}) {
    Material material;
    material.law = law;
    const Model m = jittered_box(material);
    const auto energy = [&](double by) {
      const std::vector<Vec3> x = mapped(m.rest_position, (Mat3::Identity() + by * L) * F);
      const Controls controls = initial_controls(m);
      return elastic_energy(Configuration{m, controls, x, 0.0});
    };
    const double step = 1e-5;
    const double change = (energy(step) - energy(-step)) / (2.0 * step);
    double power = 0.0;
    const std::vector<Mat3> stress = measure_stress(m, mapped(m.rest_position, F));
    for (std::size_t t = 0; t < stress.size(); ++t)
      power += m.rest_volume[t] * F.determinant() * (stress[t].transpose() * L).trace();
    EXPECT_NEAR(power, change, 1e-7 * std::abs(change)) << static_cast<int>(law);
  }
}

TEST(Stress, OfAFlatOrInvertedTetIsFinite) {
  const Model m = jittered_box({});
  Mat3 F = Mat3::Identity();
  for (const double ratio : {0.0, -1.0}) {
    F(2, 2) = ratio;
    for (const Mat3& s : measure_stress(m, mapped(m.rest_position, F))) EXPECT_TRUE(s.allFinite());
  }
}

TEST(Stress, VonMisesOfUniaxialTensionIsItsStress) {
  Mat3 stress = Mat3::Zero();
  stress(1, 1) = -7.0;
  EXPECT_NEAR(von_mises(stress), 7.0, 1e-12);
  EXPECT_NEAR(von_mises(stress + 3.0 * Mat3::Identity()), 7.0, 1e-12);
  EXPECT_NEAR(pressure_of(stress), 7.0 / 3.0, 1e-12);
}

}  // namespace
}  // namespace sinew
