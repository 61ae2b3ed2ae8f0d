#include "sinew/forces/laws.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sinew/base/error.h"
#include "sinew/forces/assemble.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

// A regular tet of edge 2 cm: V = l^3 / (6 sqrt 2).
TetMesh regular_tet(double l) {
  TetMesh m;
  m.nodes = {{0, 0, 0},
             {l, 0, 0},
             {l / 2, l * std::sqrt(3.0) / 2, 0},
             {l / 2, l / (2 * std::sqrt(3.0)), l * std::sqrt(2.0 / 3.0)}};
  m.tets = {{0, 1, 2, 3}};
  return m;
}

BodySpec spec_of(TetMesh mesh, Material material) {
  BodySpec spec;
  spec.name = "tet";
  spec.mesh = std::move(mesh);
  spec.materials = {material};
  spec.regions = {"all"};
  return spec;
}

TEST(Laws, LloydOnARegularTetByHand) {
  // k = 2 sqrt(2)/25 * 0.02 m * 10 kPa = 22.627 N/m, whichever length is used.
  for (const LloydLength length : {LloydLength::tet, LloydLength::edge}) {
    Material material{.law = Law::lloyd, .young = 10e3};
    material.length = length;
    Model m;
    add_body(m, spec_of(regular_tet(0.02), material));
    ASSERT_EQ(m.spring_count(), 6);
    for (const double k : m.stiffness) EXPECT_NEAR(k, 22.62741699796952, 1e-10);
    for (const double l : m.rest_length) EXPECT_NEAR(l, 0.02, 1e-15);
  }
}

TEST(Laws, VanGelderByHand) {
  // E V / l^2 with V = l^3/(6 sqrt 2): E l / (6 sqrt 2) = 10e3 * 0.02 / 8.485281 = 23.570226.
  Material material{.law = Law::vangelder, .young = 10e3};
  Model m;
  add_body(m, spec_of(regular_tet(0.02), material));
  for (const double k : m.stiffness) EXPECT_NEAR(k, 23.570226039551585, 1e-9);
}

TEST(Laws, UniformTakesTheConstantsOfTheTalk) {
  Material material{.law = Law::uniform};
  Model m = test::tissue_box(material, {2, 2, 2});
  for (const double k : m.stiffness) EXPECT_NEAR(k, 200'000.0, 1e-6);
  for (const double c : m.damping) EXPECT_NEAR(c, 3'000.0, 1e-8);
}

TEST(Laws, SharedEdgesAddUpWhatEveryTetGives) {
  // Two regular tets glued at a face: the three shared edges have twice the stiffness.
  TetMesh mesh = regular_tet(0.02);
  const Vec3 base = (mesh.nodes[0] + mesh.nodes[1] + mesh.nodes[2]) / 3.0;
  mesh.nodes.push_back(2.0 * base - mesh.nodes[3]);
  mesh.tets.push_back({0, 2, 1, 4});
  Model m;
  add_body(m, spec_of(mesh, {.law = Law::lloyd, .young = 10e3}));
  ASSERT_EQ(m.spring_count(), 9);
  for (Index s = 0; s < 9; ++s) {
    const bool shared = m.springs[uz(s)][1] < 3;
    EXPECT_NEAR(m.stiffness[uz(s)], (shared ? 2 : 1) * 22.62741699796952, 1e-9);
  }
}

TEST(Laws, DampingsByHand) {
  // m_red of equal masses m is m/2: c = 2 * 0.1 * sqrt(50 * 1) = 1.41421.
  EXPECT_NEAR(ratio_damping(0.1, 50.0, 2.0, 2.0), 1.4142135623730951, 1e-14);
  // 2 sqrt(50 * (2 + 2)) / 0.5 = 56.5685.
  EXPECT_NEAR(published_damping(50.0, 2.0, 2.0, 0.5), 56.568542494923804, 1e-12);
}

TEST(Laws, MassesAreAQuarterOfEveryTetAndAddUpToDensityTimesVolume) {
  Model m = test::tissue_box({.density = 1060.0}, {3, 2, 2}, Vec3(0.3, 0.2, 0.1));
  double mass = 0.0;
  for (const double x : m.mass) mass += x;
  EXPECT_NEAR(mass, 1060.0 * 0.006, 1e-12);
  EXPECT_NEAR(m.bodies[0].rest_volume, 0.006, 1e-15);
}

TEST(Laws, RegionsKeepTheirOwnLaw) {
  BodySpec spec = spec_of(box(Vec3(0.1, 0.1, 0.2), {2, 2, 4}), {});
  spec.materials = {{.law = Law::lloyd, .young = 1e4}, {.law = Law::lloyd, .young = 1e6}};
  spec.materials[1].stretch_limit = 0.1;
  spec.regions = {"soft", "stiff"};
  for (const Tet& t : spec.mesh.tets) {
    double z = 0.0;
    for (const Index n : t) z += spec.mesh.nodes[uz(n)].z() / 4;
    spec.tet_region.push_back(z > 0.0 ? 1 : 0);
  }
  Model m;
  add_body(m, spec);
  for (Index s = 0; s < m.spring_count(); ++s) {
    const double z0 = m.rest_position[uz(m.springs[uz(s)][0])].z();
    const double z1 = m.rest_position[uz(m.springs[uz(s)][1])].z();
    const double per_length = m.stiffness[uz(s)] / m.rest_length[uz(s)];
    if (std::max(z0, z1) < -1e-9) {
      EXPECT_LT(per_length, 1.2e4);
    }
    if (std::min(z0, z1) > 1e-9) {
      EXPECT_GT(per_length, 1e5);
    }
    if (std::min(z0, z1) > 1e-9) {
      EXPECT_EQ(m.stretch_limit[uz(s)], 0.1);
    }
    if (std::max(z0, z1) < -1e-9) {
      EXPECT_EQ(m.stretch_limit[uz(s)], no_limit);
    }
  }
}

TEST(Assemble, ANodeInTwoPinsIsRefused) {
  Model m = test::tissue_box({}, {1, 1, 1});
  m.pins = {{"left", {0, 1}, {}}, {"right", {1, 2}, {}}};
  try {
    finish(m);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.message(), "body box, node 1 is held by two pins, 'left' and 'right'");
  }
}

TEST(Assemble, EveryNodeListsItsSpringsOnce) {
  Model m = test::tissue_box({}, {3, 3, 3});
  finish(m);
  std::vector<int> seen(2 * m.springs.size(), 0);
  for (Index n = 0; n < m.node_count(); ++n) {
    for (Index k = m.spring_start[uz(n)]; k < m.spring_start[uz(n) + 1]; ++k) {
      const Index e = m.node_spring[uz(k)];
      EXPECT_EQ(m.springs[uz(e >> 1)][uz(e & 1)], n);
      ++seen[uz(e)];
    }
  }
  for (const int count : seen) EXPECT_EQ(count, 1);
}

}  // namespace
}  // namespace sinew
