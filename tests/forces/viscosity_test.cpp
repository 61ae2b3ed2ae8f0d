#include "sinew/forces/viscosity.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "sinew/base/random.h"
#include "sinew/forces/stiffness.h"
#include "sinew/forces/terms.h"
#include "tests/support/fields.h"
#include "tests/support/forces.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

using test::mapped;
using test::scattered;
using test::shaken;

using Field = std::vector<Vec3>;

// A box of 0.1 m on an irregular mesh that only its viscosity of 20 Pa s damps.
Model viscous_box(Law law = Law::neo_hookean, double beta = default_beta) {
  Material material;
  material.law = law;
  material.beta = beta;
  material.damping_ratio = 0.0;
  material.viscosity = 20.0;
  BodySpec spec;
  spec.name = "box";
  spec.mesh = box(Vec3(0.1, 0.1, 0.1), {2, 2, 2}, 0.25);
  spec.materials = {material};
  spec.regions = {"all"};
  Model m;
  m.start_gravity = Vec3::Zero();
  add_body(m, spec);
  finish(m);
  return m;
}

Mat3 edges_of(const Field& x, const Tet& t) {
  Mat3 edges;
  edges << x[uz(t[1])] - x[uz(t[0])], x[uz(t[2])] - x[uz(t[0])], x[uz(t[3])] - x[uz(t[0])];
  return edges;
}

// What the viscosity alone pulls every node with: -C v.
Field pulls(const Model& m, const Field& x, const Field& v) {
  Field out(x.size());
  test::tangent_times({m, initial_controls(m), x}, 0.0, 1.0, v, Tangent::full, out);
  for (Vec3& f : out) f = -f;
  return out;
}

double power(const Model& m, const Field& x, const Field& v) {
  return viscous_power(m, x, v, v);
}

TEST(Viscosity, ForceIsMinusTheGradientOfTheDissipation) {
  const Model m = viscous_box();
  const Field x = shaken(m.rest_position, 0.02);
  const Field v = scattered(x.size(), 1.0, 50);
  const Field f = pulls(m, x, v);
  for (std::size_t i = 0; i < x.size(); i += 3) {
    for (int c = 0; c < 3; ++c) {
      Field above = v, below = v;
      above[i][c] += 0.5;  // D is a quadratic: its central difference is exact
      below[i][c] -= 0.5;
      const double slope =
          0.5 * (viscous_power(m, x, above, above) - viscous_power(m, x, below, below));
      EXPECT_NEAR(f[i][c], -slope, 1e-10 * f[i].norm());
    }
  }
}

// beta = 1: on tets alone; -2 eta V F (dE/dt) G_a, written out with matrices of edges.
TEST(Viscosity, OfTetsIsThatOfTheFormula) {
  const Model m = viscous_box(Law::neo_hookean, 1.0);
  const Field x = shaken(m.rest_position, 0.02);
  const Field v = scattered(x.size(), 1.0, 50);
  Field expected(x.size(), Vec3::Zero());
  for (std::size_t t = 0; t < m.tets.size(); ++t) {
    const Mat3 B = edges_of(m.rest_position, m.tets[t]).inverse();
    const Mat3 F = edges_of(x, m.tets[t]) * B;
    const Mat3 rate = F.transpose() * edges_of(v, m.tets[t]) * B;
    const Mat3 stress = F * 20.0 * (rate + rate.transpose());
    const Mat3 forces = -m.rest_volume[t] * stress * B.transpose();
    expected[uz(m.tets[t][0])] -= forces.rowwise().sum();
    for (int a = 0; a < 3; ++a) expected[uz(m.tets[t][uz(a + 1)])] += forces.col(a);
  }
  const Field f = pulls(m, x, v);
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_LE((f[i] - expected[i]).norm(), 1e-11 * expected[i].norm());
  }
}

TEST(Viscosity, IsPartOfAllForcesAndItsHeatOfTheAccount) {
  for (const Law law : {Law::neo_hookean, Law::lloyd, Law::uniform}) {
    const Model m = viscous_box(law);
    State s = initial_state(m);
    s.position = shaken(m.rest_position, 0.01);
    const NodalForces still = test::forces_at(m, initial_controls(m), s);
    EXPECT_EQ(still.heat, 0.0);
    s.half_velocity = scattered(s.position.size(), 1.0, 50);
    const NodalForces moving = test::forces_at(m, initial_controls(m), s);
    const Field damping = pulls(m, s.position, s.half_velocity);
    double loss = 0.0;
    for (std::size_t i = 0; i < damping.size(); ++i) {
      EXPECT_LE((moving.force[i] - still.force[i] - damping[i]).norm(), 1e-9 * damping[i].norm());
      loss -= damping[i].dot(s.half_velocity[i]);
    }
    EXPECT_NEAR(moving.heat, loss, 1e-12 * loss);
  }
}

TEST(Viscosity, ARigidMotionOfATurnedAndStrainedBodyFeelsNothing) {
  const Model m = viscous_box();
  for (const double flatten : {1.0, 0.0, -0.7}) {  // as it is, flat, inside out
    Field x = shaken(m.rest_position, 0.02);
    for (Vec3& p : x) p.y() *= flatten;
    Field v;
    for (const Vec3& p : x) v.push_back(Vec3(1, 2, 3) + Vec3(5, -4, 3).cross(p));
    for (const Vec3& f : pulls(m, x, v)) EXPECT_LE(f.norm(), 1e-13);
    EXPECT_LE(viscous_power(m, x, v, v), 1e-13);
  }
}

TEST(Viscosity, OnlyRigidMotionsFeelNothing) {
  const Model m = viscous_box();
  const auto n = static_cast<Eigen::Index>(m.rest_position.size());
  Eigen::MatrixXd C(3 * n, 3 * n);
  Field u(m.rest_position.size(), Vec3::Zero());
  for (Eigen::Index c = 0; c < 3 * n; ++c) {
    u[static_cast<std::size_t>(c / 3)][c % 3] = 1.0;
    const Field f = pulls(m, m.rest_position, u);
    u[static_cast<std::size_t>(c / 3)][c % 3] = 0.0;
    for (Eigen::Index i = 0; i < n; ++i) {
      C.block<3, 1>(3 * i, c) = -f[static_cast<std::size_t>(i)];
    }
  }
  EXPECT_LE((C - C.transpose()).norm(), 1e-14 * C.norm());
  const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(C).eigenvalues();
  EXPECT_LE(values(5), 1e-13 * values(3 * n - 1));
  EXPECT_GE(values(6), 0.01 * values(3 * n - 1));
}

TEST(Viscosity, KeepsMomentumAndAngularMomentum) {
  const Model m = viscous_box();
  for (const double flatten : {1.0, 0.0, -0.7}) {
    Field x = shaken(m.rest_position, 0.02);
    for (Vec3& p : x) p.y() *= flatten;
    const Field f = pulls(m, x, scattered(x.size(), 1.0, 50));
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    double size = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      EXPECT_TRUE(f[i].allFinite());
      force += f[i];
      torque += x[i].cross(f[i]);
      size += f[i].norm();
    }
    EXPECT_LE(force.norm(), 1e-14 * size);
    EXPECT_LE(torque.norm(), 1e-15 * size);
  }
}

TEST(Viscosity, AffineFlowDissipatesExactly) {
  const Model m = viscous_box();
  Mat3 shear = Mat3::Zero();
  shear(0, 1) = 3.0;  // dgamma/dt [1/s]: the power is eta (dgamma/dt)^2 V
  const double volume = 1e-3;
  EXPECT_NEAR(power(m, m.rest_position, mapped(m.rest_position, shear)), 20.0 * 9.0 * volume,
              1e-12);
  // Of any flow of any deformation: 2 eta |sym(F^T dF/dt)|^2 V.
  Mat3 F, rate;
  F << 1.3, 0.2, -0.1, 0.4, 0.8, 0.3, -0.2, 0.1, 1.1;
  rate << 0.5, -1.0, 2.0, 0.3, 0.7, -0.4, 1.1, 0.2, -0.9;
  const Mat3 turning = F.transpose() * rate;
  const double square = (0.5 * (turning + turning.transpose())).squaredNorm();
  EXPECT_NEAR(power(m, mapped(m.rest_position, F), mapped(m.rest_position, rate)),
              2.0 * 20.0 * square * volume, 1e-12);
}

TEST(Viscosity, ComesFromTheRatioOfTheLongestWave) {
  Material m;
  m.young = 3000.0;
  m.poisson = 0.5 - 1e-12;  // mu = 1 kPa
  m.density = 1000.0;       // c = 1 m/s
  m.damping_ratio = 0.1;
  m.viscosity = 3.0;
  EXPECT_EQ(material_viscosity(m, 0.5), 3.0);
  m.damping = Damping::material;
  const double omega = 2.0 * std::numbers::pi;  // a wave of 1 m
  EXPECT_NEAR(material_viscosity(m, 0.5), 3.0 + 2.0 * 0.1 * 1000.0 / omega, 1e-6);
  m.law = Law::uniform;  // has no shear modulus
  EXPECT_EQ(material_viscosity(m, 0.5), 3.0);
}

TEST(Viscosity, LongestSideIsThatOfTheBodyHoweverItIsTurned) {
  const TetMesh mesh = box(Vec3(0.1, 0.4, 0.2), {1, 2, 1});
  EXPECT_NEAR(longest_side(mesh.nodes, Eigen::Quaterniond::Identity()), 0.4, 1e-15);
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
  Field turned;
  for (const Vec3& p : mesh.nodes) turned.push_back(Vec3(1, 1, 1) + turn * p);
  EXPECT_NEAR(longest_side(turned, turn), 0.4, 1e-15);
}

TEST(Viscosity, ReplacesTheDashpotsAndBelongsToItsRegion) {
  Material damped;
  damped.damping = Damping::material;
  Material dry;
  dry.damping_ratio = 0.0;
  BodySpec spec;
  spec.name = "box";
  spec.mesh = box(Vec3(0.1, 0.1, 0.2), {1, 1, 2});
  spec.materials = {damped, dry};
  spec.regions = {"damped", "dry"};
  for (const Tet& t : spec.mesh.tets) {
    double z = 0.0;
    for (const Index i : t) z += spec.mesh.nodes[uz(i)].z();
    spec.tet_region.push_back(z > 0.0 ? 1 : 0);
  }
  Model m;
  add_body(m, spec);
  finish(m);
  for (const double c : m.damping) EXPECT_EQ(c, 0.0);
  EXPECT_TRUE(m.active_springs.empty());
  for (std::size_t t = 0; t < m.tets.size(); ++t) {
    EXPECT_EQ(m.tet_viscosity[t], m.tet_region[t] == 0 ? material_viscosity(damped, 0.2) : 0.0);
  }
  spec.materials = {dry, dry};
  Model undamped;
  add_body(undamped, spec);
  finish(undamped);
  EXPECT_TRUE(undamped.tet_viscosity.empty());
  EXPECT_NE(m.hash(), undamped.hash());
}

}  // namespace
}  // namespace sinew
