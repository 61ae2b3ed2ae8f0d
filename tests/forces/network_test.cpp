#include "sinew/forces/network.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "sinew/base/random.h"
#include "sinew/forces/stress.h"
#include "sinew/forces/terms.h"
#include "sinew/forces/volume.h"
#include "sinew/forces/volume_law.h"
#include "tests/support/effort.h"
#include "tests/support/fields.h"
#include "tests/support/forces.h"
#include "tests/support/models.h"
#include "tests/support/tangent.h"
#include "tests/support/terms.h"

namespace sinew {
namespace {

using test::mapped;
using test::shaken;

Model irregular_box(const Material& material, int cells = 2, double jitter = 0.25) {
  BodySpec spec;
  spec.name = "box";
  spec.mesh = box(Vec3(0.1, 0.1, 0.1), {cells, cells, cells}, jitter);
  spec.materials = {material};
  spec.regions = {"all"};
  Model m;
  m.start_gravity = Vec3::Zero();
  add_body(m, spec);
  finish(m);
  return m;
}

std::vector<Vec3> forces(const Model& m, const std::vector<Vec3>& x) {
  State state = initial_state(m);
  state.position = x;
  return test::forces_at(m, initial_controls(m), state).force;
}

TEST(Network, AffineDeformationOfIrregularMeshesIsExact) {
  for (const double beta : {0.0, 0.3, 1.0}) {
    for (const double poisson : {0.0, 0.3, 0.45, 0.499}) {
      Material material;
      material.beta = beta;
      material.poisson = poisson;
      material.damping_ratio = 0.0;
      const Model m = irregular_box(material, 4, 0.3);
      Mat3 F;
      F << 1.1, 0.2, -0.1, 0.05, 0.9, 0.1, 0.0, -0.15, 1.05;
      const std::vector<Vec3> f = forces(m, mapped(m.rest_position, F));
      double scale = 0.0;
      for (const Vec3& e : f) scale = std::max(scale, e.norm());
      Mat3 stress = Mat3::Zero();
      for (std::size_t i = 0; i < f.size(); ++i) {
        const Vec3 X = m.rest_position[i];
        const bool inner = (X.cwiseAbs().array() < 0.05 - 1e-9).all();
        if (inner) {
          EXPECT_LE(f[i].norm(), 1e-11 * scale);
        }
        stress -= f[i] * X.transpose();
      }
      const double V = m.bodies[0].rest_volume;
      const double mu = shear_modulus(material.young, poisson);
      const double kappa = lame_lambda(material.young, poisson) + mu;
      const double J = F.determinant();
      const Mat3 P = mu * F + (kappa * (J - 1.0) - mu) * J * F.inverse().transpose();
      EXPECT_LE((stress / V - P).norm(), 1e-10 * P.norm()) << "beta " << beta << " nu " << poisson;

      const double W =
          0.5 * mu * (F.squaredNorm() - 3.0) - mu * (J - 1.0) + 0.5 * kappa * (J - 1.0) * (J - 1.0);
      EXPECT_NEAR(elastic_energy(test::at(m, mapped(m.rest_position, F))) / V, W, 1e-10 * W);
    }
  }
}

TEST(Network, ForcesAreTheNegativeGradientOfTheEnergy) {
  for (const Volume volume : {Volume::none, Volume::tet, Volume::node}) {
    for (const Law law : {Law::neo_hookean, Law::lloyd, Law::vangelder}) {
      Material material;
      material.law = law;
      material.volume = volume;
      material.damping_ratio = 0.0;
      const Model m = irregular_box(material);
      for (const double size : {0.005, 0.04}) {  // mild; tets turned over
        const std::vector<Vec3> x = shaken(m.rest_position, size);
        const std::vector<Vec3> f = forces(m, x);
        double scale = 0.0;
        for (const Vec3& e : f) scale = std::max(scale, e.norm());
        for (const std::size_t i : {std::size_t{0}, std::size_t{7}, std::size_t{13}}) {
          for (int c = 0; c < 3; ++c) {
            const double h = 1e-7;
            std::vector<Vec3> up(x), down(x);
            up[i][c] += h;
            down[i][c] -= h;
            const double slope =
                (elastic_energy(test::at(m, up)) - elastic_energy(test::at(m, down))) / (2 * h);
            EXPECT_NEAR(f[i][c], -slope, 2e-6 * scale);
          }
        }
      }
    }
  }
}

TEST(Network, TangentIsSymmetricAndTheDerivativeOfTheForces) {
  Material material;
  material.damping_ratio = 0.0;
  const Model m = irregular_box(material);
  const std::vector<Vec3> x = shaken(m.rest_position, 0.02);
  const Eigen::MatrixXd K = test::dense_tangent(m, x);
  EXPECT_LE((K - K.transpose()).norm(), 1e-12 * K.norm());
  const std::vector<Vec3> u = shaken(std::vector<Vec3>(x.size(), Vec3::Zero()), 1.0);
  const double h = 1e-7;
  std::vector<Vec3> up(x), down(x);
  Eigen::VectorXd flat(3 * x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    up[i] += h * u[i];
    down[i] -= h * u[i];
    flat.segment<3>(static_cast<Eigen::Index>(3 * i)) = u[i];
  }
  const std::vector<Vec3> f_up = forces(m, up);
  const std::vector<Vec3> f_down = forces(m, down);
  const Eigen::VectorXd product = K * flat;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec3 expected = (f_down[i] - f_up[i]) / (2.0 * h);
    EXPECT_LE((product.segment<3>(static_cast<Eigen::Index>(3 * i)) - expected).norm(),
              1e-6 * product.norm());
  }
}

TEST(Network, KeepsMomentumAndAngularMomentum) {
  Material material;
  const Model m = irregular_box(material);
  const std::vector<Vec3> x = shaken(m.rest_position, 0.03);
  const std::vector<Vec3> f = forces(m, x);
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  double scale = 0.0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    force += f[i];
    torque += x[i].cross(f[i]);
    scale += f[i].norm();
  }
  EXPECT_LE(force.norm(), 1e-13 * scale);
  EXPECT_LE(torque.norm(), 1e-13 * scale);
}

// Regions of different stiffness: the body is at rest at rest, whatever borders on what.
TEST(Network, BordersBetweenMaterialsAreAtRest) {
  BodySpec spec;
  spec.name = "box";
  spec.mesh = box(Vec3(0.1, 0.1, 0.1), {3, 3, 3}, 0.2);
  Material soft, hard, classic;
  hard.young = 50.0 * soft.young;
  hard.poisson = 0.3;
  classic.law = Law::lloyd;
  spec.materials = {soft, hard, classic};
  spec.regions = {"soft", "hard", "classic"};
  for (Index t = 0; t < spec.mesh.tet_count(); ++t) spec.tet_region.push_back(t % 3);
  Model m;
  m.start_gravity = Vec3::Zero();
  add_body(m, spec);
  finish(m);
  for (const Vec3& f : forces(m, m.rest_position)) {
    EXPECT_LE(f.norm(), 1e-12 * hard.young * 0.01);
  }
}

// A tet mesh made bad: one node is pushed towards the opposite face of one of its tets, until that
// tet keeps a thousandth of the mean volume, if no other tet turns over.
TetMesh with_sliver(Index seed) {
  const auto n = static_cast<std::uint64_t>(seed);
  TetMesh mesh = box(Vec3(0.1, 0.1, 0.1), {2, 2, 2}, 0.35 * random_number(7 * n));
  const std::vector<Vec3> start = mesh.nodes;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    mesh.nodes[i] += 0.006 * (2.0 * random_point(100 * n + i) - Vec3::Ones());
  }
  const double mean = 0.001 / static_cast<double>(mesh.tets.size());
  for (std::uint64_t attempt = 0; attempt < 40; ++attempt) {
    const auto t = static_cast<std::size_t>(random_number(991 * n + attempt) *
                                            static_cast<double>(mesh.tets.size()));
    const Tet tet = mesh.tets[t];
    const Vec3 a = mesh.nodes[uz(tet[1])];
    const Vec3 normal = (mesh.nodes[uz(tet[2])] - a).cross(mesh.nodes[uz(tet[3])] - a).normalized();
    const Vec3 kept = mesh.nodes[uz(tet[0])];
    const double volume = signed_volume(mesh.nodes, tet);
    mesh.nodes[uz(tet[0])] -= (1.0 - 0.001 * mean / volume) * normal.dot(kept - a) * normal;
    double smallest = 1.0;
    for (const Tet& other : mesh.tets) {
      smallest = std::min(smallest, signed_volume(mesh.nodes, other) / mean);
    }
    if (smallest > 0.0009) return mesh;
    mesh.nodes[uz(tet[0])] = kept;
  }
  mesh.nodes = start;
  return mesh;
}

TEST(Network, PressureAtRestAndUnderAUniformStrain) {
  for (const Volume volume : {Volume::node, Volume::tet}) {
    Material material;
    material.volume = volume;
    const Model m = irregular_box(material);
    State state = initial_state(m);
    for (const Mat3& s : measure_stress(m, state.position)) {
      EXPECT_NEAR(pressure_of(s), 0.0, 1e-9 * material.young);
    }
    const double strain = 1e-6;
    state.position = mapped(m.rest_position, (1.0 - strain) * Mat3::Identity());
    const double bulk = material.young / (3.0 * (1.0 - 2.0 * material.poisson));
    for (const Mat3& s : measure_stress(m, state.position)) {
      EXPECT_NEAR(pressure_of(s), 3.0 * strain * bulk, 1e-4 * strain * bulk);
    }
  }
}

// Plates, rods and blocks of cells with aspects up to 50, in one to five layers: no mode but the
// six rigid ones has an energy of zero or less, with beta = 0 too.
TEST(Network, IsStableForFlatAndLongCells) {
  const std::array<double, 6> aspects = {1.0, 2.5, 4.0, 7.0, 15.0, 50.0};
  const std::array<double, 6> poissons = {-0.3, 0.0, 0.2, 0.35, 0.45, 0.499};
  int cases = 0;
  for (std::size_t a = 0; a < aspects.size(); ++a) {
    for (std::size_t n = 0; n < poissons.size(); ++n) {
      for (Index layers = 1; layers <= 5; ++layers, ++cases) {
        if (test::sanitized && cases % 37 != 0) continue;
        const bool rod = cases % 3 == 2;
        const bool is_beam = cases % 2 == 1;
        const double jitter = cases % 4 == 3 ? 0.3 : 0.0;
        const Index across = layers < 3 ? 4 : 2;
        const std::array<Index, 3> cells = {across, layers, rod ? 2 : across};
        const Vec3 edges = rod ? Vec3(0.01, 0.01, 0.01 * aspects[a])
                               : Vec3(0.01 * aspects[a], 0.01, 0.01 * aspects[a]);
        const Vec3 size = edges.cwiseProduct(Vec3(cells[0], cells[1], cells[2]));
        BodySpec spec;
        spec.name = "plate";
        spec.mesh = is_beam ? beam(size, cells, jitter) : box(size, cells, jitter);
        Material material;
        material.poisson = poissons[n];
        material.beta = cases % 5 < 3 ? 0.0 : default_beta;
        spec.materials = {material};
        spec.regions = {"all"};
        Model m;
        add_body(m, spec);
        finish(m);
        // By the springs' own scale: modes of thin plates have tiny eigenvalues by nature.
        const Eigen::MatrixXd K = test::dense_tangent(m, m.rest_position);
        const Eigen::VectorXd e =
            Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K, Eigen::EigenvaluesOnly).eigenvalues();
        const double rounding = 1e-13 * e(e.size() - 1);
        EXPECT_GT(e(0), -10.0 * rounding) << "case " << cases;
        EXPECT_GT(e(6), 3.0 * rounding) << "case " << cases << " aspect " << aspects[a] << " nu "
                                        << poissons[n] << " layers " << layers;
        EXPECT_LT(std::abs(e(5)), 0.3 * e(6)) << "case " << cases;
      }
    }
  }
}

TEST(Network, HasNoSpuriousModeOnRandomMeshesWithSlivers) {
  int slivers = 0;
  const int seeds = test::effort(200);
  for (Index seed = 0; seed < seeds; ++seed) {
    BodySpec spec;
    spec.name = "box";
    spec.mesh = with_sliver(seed);
    Material material;
    material.poisson = std::array{0.0, 0.3, 0.45, 0.49, 0.499}[uz(seed % 5)];
    spec.materials = {material};
    spec.regions = {"all"};
    Model m;
    add_body(m, spec);
    finish(m);
    double smallest = 1.0;
    for (const double v : m.rest_volume) smallest = std::min(smallest, v);
    slivers += smallest * static_cast<double>(m.tets.size()) < 0.0011 * 0.001 ? 1 : 0;
    const Eigen::MatrixXd K = test::dense_tangent(m, m.rest_position);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(K, Eigen::EigenvaluesOnly);
    const Eigen::VectorXd& e = solver.eigenvalues();
    const double unit = material.young * 0.1;  // what a mode of the whole box has
    EXPECT_LE(std::abs(e(0)), 1e-9 * e(e.size() - 1)) << "seed " << seed;
    EXPECT_GT(e(6), 1e-3 * unit) << "seed " << seed << " nu " << material.poisson;
    EXPECT_LE(std::abs(e(5)), 1e-3 * e(6)) << "seed " << seed;
  }
  EXPECT_GT(slivers, seeds / 2);
}

}  // namespace
}  // namespace sinew
