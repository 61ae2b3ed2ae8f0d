// The law neo-hookean with beta = 1 and a cell per tet is linear-tet finite elements: against an
// element written from the deformation gradient, and against CalculiX's C3D4.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "sinew/base/random.h"
#include "sinew/forces/stiffness.h"
#include "sinew/forces/terms.h"
#include "sinew/solver/static.h"
#include "tests/support/forces.h"
#include "tests/support/models.h"
#include "tests/support/source_dir.h"
#include "tests/support/terms.h"

namespace sinew {
namespace {

Material linear_tets(double young, double poisson) {
  Material material;
  material.young = young;
  material.poisson = poisson;
  material.beta = 1.0;
  material.volume = Volume::tet;
  material.damping_ratio = 0.0;
  return material;
}

Mat3 cofactor(const Mat3& F) {
  Mat3 c;
  for (int a = 0; a < 3; ++a) c.col(a) = F.col((a + 1) % 3).cross(F.col((a + 2) % 3));
  return c;
}

// What the element gives at x and along u.
struct Element {
  double energy = 0.0;             // [J]
  std::vector<Vec3> force;         // [N] (nodes)
  std::vector<Vec3> force_change;  // by u, to first order (nodes)
};

// Stable neo-Hookean energy without the logarithm (Smith, de Goes, Kim 2018) on linear tets:
//   P = mu F + (kappa (J - 1) - mu) cof F
//   dP = mu dF + kappa (cof F : dF) cof F + (kappa (J - 1) - mu) dcof
Element element(const Model& m, const Material& mat, const std::vector<Vec3>& x,
                const std::vector<Vec3>& u) {
  const double mu = mat.young / (2.0 * (1.0 + mat.poisson));
  const double kappa =
      mat.young * mat.poisson / ((1.0 + mat.poisson) * (1.0 - 2.0 * mat.poisson)) + mu;
  Element e{0.0, std::vector<Vec3>(x.size(), Vec3::Zero()),
            std::vector<Vec3>(x.size(), Vec3::Zero())};
  for (const Tet& t : m.tets) {
    const auto edges = [&](const std::vector<Vec3>& p) {
      Mat3 columns;
      for (int a = 0; a < 3; ++a) columns.col(a) = p[uz(t[uz(a + 1)])] - p[uz(t[0])];
      return columns;
    };
    const Mat3 rest = edges(m.rest_position);
    const Mat3 inverse = rest.inverse();
    const Mat3 F = edges(x) * inverse;
    const Mat3 dF = edges(u) * inverse;
    const double J = F.determinant();
    const double V = rest.determinant() / 6.0;
    const Mat3 cof = cofactor(F);
    // cof is quadratic in F: its change along dF is exactly half of a difference.
    const Mat3 dcof = 0.5 * (cofactor(F + dF) - cofactor(F - dF));
    e.energy += V * (0.5 * mu * (F.squaredNorm() - 3.0) - mu * (J - 1.0) +
                     0.5 * kappa * (J - 1.0) * (J - 1.0));
    const double pressure = kappa * (J - 1.0) - mu;
    const Mat3 H = V * (mu * F + pressure * cof) * inverse.transpose();
    const Mat3 dH = V * (mu * dF + kappa * cof.cwiseProduct(dF).sum() * cof + pressure * dcof) *
                    inverse.transpose();
    for (int a = 0; a < 3; ++a) {
      e.force[uz(t[uz(a + 1)])] -= H.col(a);
      e.force[uz(t[0])] += H.col(a);
      e.force_change[uz(t[uz(a + 1)])] -= dH.col(a);
      e.force_change[uz(t[0])] += dH.col(a);
    }
  }
  return e;
}

double largest(const std::vector<Vec3>& f) {
  double size = 0.0;
  for (const Vec3& v : f) size = std::max(size, v.norm());
  return size;
}

double distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double sign = 1.0) {
  double size = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) size = std::max(size, (a[i] - sign * b[i]).norm());
  return size;
}

TEST(LinearTet, EnergyForceAndHessianProductAreTheElements) {
  for (const double poisson : {0.0, 0.3, 0.45, 0.499}) {
    const Material material = linear_tets(1e4, poisson);
    BodySpec spec;
    spec.name = "box";
    spec.mesh = box(Vec3(0.1, 0.1, 0.1), {2, 2, 2}, 0.25);
    spec.materials = {material};
    spec.regions = {"all"};
    Model m;
    m.start_gravity = Vec3::Zero();
    add_body(m, spec);
    finish(m);
    for (const double size : {0.002, 0.01, 0.1}) {  // the last turns half of the tets inside out
      State state = initial_state(m);
      std::vector<Vec3>& x = state.position;
      std::vector<Vec3> u(x.size());
      for (std::size_t i = 0; i < x.size(); ++i) {
        x[i] += size * (2.0 * random_point(i + 1000) - Vec3::Ones());
        u[i] = 2.0 * random_point(i + 2000) - Vec3::Ones();
      }
      const Element expected = element(m, material, x, u);
      const std::vector<Vec3> force = test::forces_at(m, initial_controls(m), state).force;
      EXPECT_LE(distance(force, expected.force), 1e-10 * largest(expected.force));
      EXPECT_NEAR(elastic_energy(test::at(m, x)), expected.energy, 1e-10 * expected.energy);
      std::vector<Vec3> product(x.size());
      test::tangent_times({m, initial_controls(m), x}, 1.0, 0.0, u, Tangent::full, product);
      EXPECT_LE(distance(product, expected.force_change, -1.0),
                1e-10 * largest(expected.force_change));
    }
  }
}

// The next line that is no comment.
std::istringstream data_line(std::istream& in) {
  std::string line;
  do std::getline(in, line);
  while (in && line.starts_with("#"));
  return std::istringstream(line);
}

TEST(LinearTet, SmallStrainsAreThoseOfC3D4) {
  std::ifstream in(test::source_path("tests/data/c3d4.txt"));  // tools/referee_c3d4.py
  ASSERT_TRUE(in);
  double young = 0.0, poisson = 0.0;
  std::size_t nodes = 0, tets = 0;
  data_line(in) >> young >> poisson;
  data_line(in) >> nodes >> tets;
  BodySpec spec;
  spec.name = "block";
  spec.materials = {linear_tets(young, poisson)};
  spec.regions = {"all"};
  Pin held{"held", {}, {}};
  std::vector<Load> loads;
  std::vector<Vec3> expected(nodes);
  for (std::size_t i = 0; i < nodes; ++i) {
    Vec3 X, f;
    int is_held = 0;
    data_line(in) >> X.x() >> X.y() >> X.z() >> is_held >> f.x() >> f.y() >> f.z() >>
        expected[i].x() >> expected[i].y() >> expected[i].z();
    spec.mesh.nodes.push_back(X);
    if (is_held != 0) held.nodes.push_back(static_cast<Index>(i));
    if (f != Vec3::Zero()) loads.push_back({"pull", {static_cast<Index>(i)}, f});
  }
  for (std::size_t t = 0; t < tets; ++t) {
    Tet tet{};
    std::istringstream line = data_line(in);
    for (Index& node : tet) line >> node;
    spec.mesh.tets.push_back(tet);
  }
  ASSERT_GT(loads.size(), 3U);
  Model m;
  m.start_gravity = Vec3::Zero();
  add_body(m, spec);
  m.pins = {held};
  m.loads = loads;
  finish(m);
  State state = initial_state(m);
  StaticSolver(m).solve(initial_controls(m), 1.0, {}, state);
  std::vector<Vec3> moved(nodes);
  for (std::size_t i = 0; i < nodes; ++i) moved[i] = state.position[i] - m.rest_position[i];
  EXPECT_LE(distance(moved, expected), 1e-4 * largest(expected));
}

}  // namespace
}  // namespace sinew
