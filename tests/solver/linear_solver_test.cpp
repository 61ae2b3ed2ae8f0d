#include "sinew/solver/linear_solver.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sinew/forces/assemble.h"
#include "sinew/forces/terms.h"
#include "sinew/mesh/shapes.h"
#include "tests/support/forces.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

Field noise(const Model& m, double size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-size, size);
  Field u(m.rest_position.size(), Vec3::Zero());
  for (std::size_t i = 0; i < u.size(); ++i) {
    if (m.inverse_mass[i] > 0.0) u[i] = Vec3(uniform(random), uniform(random), uniform(random));
  }
  return u;
}

Model clamped_bar(Index k, const Material& material) {
  Model m;
  BodySpec body;
  body.name = "bar";
  body.mesh = beam(Vec3(0.1, 0.1, 0.4), {k, k, 4 * k});
  body.materials = {material};
  body.regions = {"all"};
  add_body(m, body);
  Pin clamp;
  for (Index i = 0; i < m.node_count(); ++i) {
    if (m.rest_position[uz(i)].z() < 1e-9) clamp.nodes.push_back(i);
  }
  m.pins.push_back(clamp);
  finish(m);
  return m;
}

// The products in single precision against those in double, at a deformed state of a bar.
// from_tets: with the tets in double precision, as for a model of other volume stiffness.
double difference(const Model& m, double inertia, double rate, bool from_tets = false,
                  double moved = 2e-3) {
  State s = initial_state(m);
  const Field jitter = noise(m, moved, 1);
  for (std::size_t i = 0; i < jitter.size(); ++i) s.position[i] += jitter[i];
  const Field lagged = m.rest_position;
  const Model other = m;
  const Controls controls = initial_controls(m);
  Objective objective{.model = from_tets ? other : m,
                      .controls = controls,
                      .inertia = inertia,
                      .rate = rate,
                      .from = &lagged,
                      .lagged = &lagged};
  TangentOperator matrix(m, std::make_shared<PackedLayout>(m));
  ForceEvaluator forces(objective.model, Precision::double_);
  matrix.assemble(objective, s.position, 0.0, forces);

  const Field u = noise(m, 1.0, 2);
  Field plain(u.size()), damped(u.size());
  test::tangent_times({m, initial_controls(m), s.position}, 1.0, 0.0, u, Tangent::full, plain);
  test::tangent_times({m, initial_controls(m), lagged}, 0.0, 1.0, u, Tangent::full, damped);
  Field4 u4(u.size()), fast(u.size());
  for (std::size_t i = 0; i < u.size(); ++i) {
    plain[i] += rate * damped[i];
    if (m.inverse_mass[i] > 0.0) plain[i] += inertia * m.mass[i] * u[i];
    u4[i] = Float4(u[i]);
  }
  matrix.times(u4, fast);
  double error = 0.0, size = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    error += (fast[i].vec3() - plain[i]).squaredNorm();
    size += plain[i].squaredNorm();
  }
  return std::sqrt(error / size);
}

TEST(TangentOperator, IsTheProductOfTheTerms) {
  Material network;
  EXPECT_LT(difference(clamped_bar(2, network), 0.0, 0.0), 1e-6);
  EXPECT_LT(difference(clamped_bar(2, network), 3600.0, 60.0), 1e-6);
  network.poisson = 0.499;
  EXPECT_LT(difference(clamped_bar(2, network), 0.0, 0.0), 1e-6);
  network.beta = 1.0;
  network.volume = Volume::tet;
  EXPECT_LT(difference(clamped_bar(2, network), 0.0, 0.0), 1e-6);
  Material lloyd;
  lloyd.law = Law::lloyd;
  EXPECT_LT(difference(clamped_bar(2, lloyd), 3600.0, 60.0), 1e-6);
  Material calibrated;
  calibrated.law = Law::calibrated;
  EXPECT_LT(difference(clamped_bar(2, calibrated), 3600.0, 60.0), 1e-6);
  Material guarded = network;
  guarded.beta = 0.02;
  guarded.volume = Volume::node;
  EXPECT_LT(difference(clamped_bar(2, guarded), 0.0, 0.0, true), 1e-6);
  for (const bool from_tets : {false, true})  // 3 cm of an edge of 5 cm turn tets inside out
    EXPECT_LT(difference(clamped_bar(2, guarded), 0.0, 0.0, from_tets, 3e-2), 1e-6);
  EXPECT_LT(difference(clamped_bar(2, lloyd), 3600.0, 60.0, true), 1e-6);
  Material viscous;
  viscous.viscosity = 100.0;
  EXPECT_LT(difference(clamped_bar(2, viscous), 3600.0, 60.0, true), 1e-6);
  EXPECT_LT(difference(clamped_bar(2, viscous), 3600.0, 60.0), 1e-6);
}

// Iterations on the tangent at rest, for gravity, to 1e-3.
int iterations(Index k, double young, double poisson, double inertia) {
  Material material;
  material.young = young;
  material.poisson = poisson;
  const Model m = clamped_bar(k, material);
  const State s = initial_state(m);
  LinearSolver linear(m);
  Objective objective{.model = m,
                      .controls = initial_controls(m),
                      .inertia = inertia,
                      .rate = 0.0,
                      .lagged = &m.rest_position};
  ForceEvaluator forces(m, Precision::double_);
  linear.assemble(objective, s.position, 0.0, forces);
  Field p;
  return linear.solve(outer_forces(m, initial_controls(m), s), 1e-3, 1000, {}, p);
}

TEST(TwoLevel, IterationsHardlyDependOnTheMesh) {
  const int coarse = iterations(4, 1.5e6, 0.45, 0.0);
  RecordProperty("W4", coarse);
  EXPECT_LE(iterations(8, 1.5e6, 0.45, 0.0), 1.5 * coarse);
}

TEST(TwoLevel, IterationsStayBoundedWithStiffness) {
  const double inertia = 3600.0;
  const int soft = iterations(4, 1e3, 0.45, inertia);
  const int stiff = iterations(4, 1e9, 0.45, inertia);
  EXPECT_NEAR(stiff, iterations(4, 1e8, 0.45, inertia), 1);
  RecordProperty("soft", soft);
  EXPECT_LE(stiff, iterations(4, 1e9, 0.45, 0.0) + 1);
}

TEST(LinearSolver, GivesTheSolutionToItsForcing) {
  Material material;
  const Model m = clamped_bar(2, material);
  const State s = initial_state(m);
  LinearSolver linear(m);
  ForceEvaluator forces(m, Precision::double_);
  linear.assemble(Objective{m, initial_controls(m)}, s.position, 0.0, forces);
  const Field f = outer_forces(m, initial_controls(m), s);
  Field p;
  for (const double forcing : {1e-1, 1e-2, 1e-3}) {  // single precision reaches 3e-4 here
    linear.solve(f, forcing, 1000, {}, p);
    Field back(p.size());
    test::tangent_times({m, initial_controls(m), s.position}, 1.0, 0.0, p, Tangent::full, back);
    add(back, -1.0, f);
    EXPECT_LT(std::sqrt(dot(back, back)), 1.2 * forcing * std::sqrt(dot(f, f)));
  }
}

TEST(LinearSolver, ABodyThatNothingHoldsIsSolvedUpToItsMotion) {
  Material material;
  Model m = test::tissue_box(material, {3, 3, 3});
  finish(m);
  const State s = initial_state(m);
  LinearSolver linear(m);
  ForceEvaluator forces(m, Precision::double_);
  linear.assemble(Objective{m, initial_controls(m)}, s.position, 0.0, forces);
  // Forces that cancel: what the tangent makes of a displacement.
  Field f(m.rest_position.size());
  test::tangent_times({m, initial_controls(m), s.position}, 1.0, 0.0, noise(m, 1.0, 3),
                      Tangent::full, f);
  Field p, back(f.size());
  linear.solve(f, 1e-3, 1000, {}, p);
  test::tangent_times({m, initial_controls(m), s.position}, 1.0, 0.0, p, Tangent::full, back);
  add(back, -1.0, f);
  EXPECT_LT(std::sqrt(dot(back, back)), 2e-3 * std::sqrt(dot(f, f)));
}

}  // namespace
}  // namespace sinew
