#include "sinew/identify/moduli.h"

#include <gtest/gtest.h>

#include <string>

#include "sinew/io/mesh_io.h"
#include "sinew/mesh/doctor.h"
#include "sinew/mesh/shapes.h"
#include "tests/identify/support.h"
#include "tests/support/effort.h"
#include "tests/support/source_dir.h"

namespace sinew {
namespace {

using test::body_of;

TetMesh liver() {
  TetMesh mesh = io::read_mesh(test::source_path("scenes/meshes/liver-10mm.mesh"));
  for (Vec3& x : mesh.nodes) x *= 0.001;
  return mesh;
}

// Jittered until some tets keep hardly any volume.
TetMesh slivers() {
  TetMesh mesh = box(Vec3(0.1, 0.1, 0.1), {4, 4, 4}, 0.25);
  const Tet t = mesh.tets[200];
  const Vec3 a = mesh.nodes[uz(t[1])];
  const Vec3 n = (mesh.nodes[uz(t[2])] - a).cross(mesh.nodes[uz(t[3])] - a).normalized();
  Vec3& x = mesh.nodes[uz(t[0])];
  x -= 0.9 * n.dot(x - a) * n;
  return mesh;
}

TEST(Moduli, OfAnIsotropicStiffnessAreItsOwn) {
  const double E = 2000.0, nu = 0.4;
  const double mu = E / (2.0 * (1.0 + nu));
  const double lambda = E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
  Mat6 C = Mat6::Zero();
  C.topLeftCorner<3, 3>().setConstant(lambda);
  C.diagonal() += Eigen::Matrix<double, 6, 1>(2 * mu, 2 * mu, 2 * mu, mu, mu, mu);
  const Moduli m = moduli_of(C);
  EXPECT_NEAR(m.young, E, 1e-9 * E);
  EXPECT_NEAR(m.poisson, nu, 1e-12);
  EXPECT_NEAR(m.shear, mu, 1e-9 * mu);
  EXPECT_NEAR(m.bulk, lambda + 2.0 * mu / 3.0, 1e-9 * lambda);
  EXPECT_NEAR(m.young_along.y(), E, 1e-9 * E);
  EXPECT_NEAR(m.shear_in.z(), mu, 1e-9 * mu);
  EXPECT_NEAR(m.anisotropy, 0.0, 1e-12);
}

void expect_asked(const TetMesh& mesh, double poisson, TestKind kind) {
  Material material;
  material.young = 12e3;
  material.poisson = poisson;
  const Moduli m = moduli_of(measure_stiffness(body_of(mesh, material), kind));
  const double shear = shear_modulus(12e3, poisson);
  EXPECT_NEAR(m.young, 12e3, 1e-6 * 12e3);
  EXPECT_NEAR(m.poisson, poisson, 1e-6);
  EXPECT_NEAR(m.shear, shear, 1e-6 * shear);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(m.young_along[axis], 12e3, 1e-6 * 12e3);
    EXPECT_NEAR(m.shear_in[axis], shear, 1e-6 * shear);
  }
  EXPECT_NEAR(m.anisotropy, 0.0, 1e-6);
}

TEST(Moduli, OfTheNetworkLawAreThoseAskedForOnAnyMesh) {
  for (const TetMesh& mesh : {box(Vec3(0.1, 0.1, 0.1), {4, 4, 4}, 0.3), slivers()}) {
    for (const double poisson : {0.1, 0.3, 0.45, 0.49}) {
      expect_asked(mesh, poisson, TestKind::traction);
      expect_asked(mesh, poisson, TestKind::displacement);
    }
  }
  if (test::sanitized) return;
  expect_asked(liver(), 0.45, TestKind::traction);
  expect_asked(liver(), 0.45, TestKind::displacement);
}

TEST(Moduli, ShowHowFarOffTheClassicLawsAre) {
  Material material;
  material.law = Law::lloyd;
  material.young = 12e3;
  const TetMesh mesh = box(Vec3(0.1, 0.1, 0.1), {4, 4, 4}, 0.3);
  const Moduli pulled = moduli_of(measure_stiffness(body_of(mesh, material), TestKind::traction));
  EXPECT_LT(pulled.poisson, 0.3);  // 0.45 was asked for
  EXPECT_GT(std::abs(pulled.young / 12e3 - 1.0), 0.05);
  // A displacement of the whole surface leaves less freedom than a traction.
  const Moduli moved =
      moduli_of(measure_stiffness(body_of(mesh, material), TestKind::displacement));
  EXPECT_GT(moved.bulk, pulled.bulk);
  EXPECT_GT(moved.shear, pulled.shear);
}

}  // namespace
}  // namespace sinew
