#include "sinew/solver/static.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sinew/base/error.h"
#include "sinew/forces/stiffness.h"
#include "sinew/forces/terms.h"
#include "tests/support/forces.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

// The bar W(k): 0.1 x 0.1 x 0.4 m, clamped at z = 0, hanging down along -y.
Model bar(const Material& material, int k) {
  BodySpec spec;
  spec.name = "bar";
  spec.mesh = beam(Vec3(0.1, 0.1, 0.4), {k, k, 4 * k});
  spec.materials = {material};
  spec.regions = {"all"};
  Model m;
  add_body(m, spec);
  m.pins.push_back({"clamp", test::nodes_at(m, 2, 0.0), {}});
  finish(m);
  return m;
}

double tip(const Model& m, const State& state) {
  double sum = 0.0;
  const std::vector<Index> end = test::nodes_at(m, 2, 0.4);
  for (const Index i : end) sum += state.position[uz(i)].y() - m.rest_position[uz(i)].y();
  return sum / static_cast<double>(end.size());
}

double largest_free_force(const Model& m, const State& state) {
  const std::vector<Vec3> force = test::forces_at(m, initial_controls(m), state).force;
  double largest = 0.0;
  for (std::size_t i = 0; i < m.rest_position.size(); ++i) {
    if (m.inverse_mass[i] > 0.0) largest = std::max(largest, force[i].norm());
  }
  return largest;
}

// Truth: converged quadratic hexahedra (validation/beam). Linear tets give 0.0226 here.
TEST(Static, TipOfTheBarIsThatOfTheMaterial) {
  Material material;
  material.young = 1.5e6;
  material.poisson = 0.45;
  const Model m = bar(material, 4);
  State state = initial_state(m);
  StaticSolver solver(m);
  const StepReport report = solver.solve(initial_controls(m), 1.0, {}, state);
  EXPECT_LE(report.residual, 1e-6);
  EXPECT_NEAR(tip(m, state), -0.0270, 0.015 * 0.0270);
  EXPECT_LE(largest_free_force(m, state), 1e-6 * 9.81 * 4.24);
  EXPECT_EQ(state.time, 1.0);
}

TEST(Static, LinearTetsAreTheKnownReference) {
  Material material;
  material.young = 1.5e6;
  material.poisson = 0.45;
  material.beta = 1.0;
  material.volume = Volume::tet;
  const Model m = bar(material, 4);
  State state = initial_state(m);
  StaticSolver(m).solve(initial_controls(m), 1.0, {}, state);
  EXPECT_NEAR(tip(m, state), -0.0226, 0.0001);
}

TEST(Static, EveryLawAndVolumeComesToRest) {
  for (const Law law : {Law::neo_hookean, Law::lloyd, Law::vangelder}) {
    for (const Volume volume : {Volume::none, Volume::tet, Volume::node}) {
      if (law == Law::neo_hookean && volume == Volume::none)
        continue;  // has no rest state of its own
      Material material;
      material.law = law;
      material.volume = volume;
      material.young = 300e3;
      const Model m = bar(material, 2);
      State state = initial_state(m);
      const StepReport report = StaticSolver(m).solve(initial_controls(m), 1.0, {}, state);
      EXPECT_LE(report.residual, 1e-6);
      EXPECT_LE(largest_free_force(m, state), 1e-6 * 9.81 * 4.24);
    }
  }
}

TEST(Static, FollowsAPinThatTurnsHalfARound) {
  Material material;
  Model m = bar(material, 3);
  m.start_gravity = Vec3::Zero();
  Pin turn{"turn", test::nodes_at(m, 2, 0.4), {}};
  turn.path.pivot = Vec3(0.0, 0.0, 0.4);
  turn.path.keys = {{1.0, Vec3::Zero(), Vec3(0.0, 0.0, 3.14159265358979)}};
  m.pins.push_back(turn);
  finish(m);
  State state = initial_state(m);
  const StepReport report = StaticSolver(m).solve(initial_controls(m), 1.0, {}, state);
  EXPECT_LE(report.residual, 1e-6);
  EXPECT_GE(report.load_steps, 9);
  // Half way along, the section has turned by a quarter round, by symmetry.
  for (Index i = 0; i < m.node_count(); ++i) {
    const Vec3& X = m.rest_position[uz(i)];
    if (std::abs(X.z() - 0.2) > 1e-9 || X.head<2>().norm() < 0.04) continue;
    const double cosine = X.head<2>().dot(state.position[uz(i)].head<2>()) /
                          (X.head<2>().norm() * state.position[uz(i)].head<2>().norm());
    EXPECT_NEAR(cosine, 0.0, 0.15);
  }
}

TEST(Static, FindsBackFromTangledStarts) {
  for (const double poisson : {0.3, 0.45, 0.499}) {
    for (const test::Tangle tangle : test::tangles) {
      Material material;
      material.poisson = poisson;
      Model m = test::tissue_box(material, {3, 3, 3});
      m.start_gravity = Vec3::Zero();
      m.pins.push_back({"floor", test::nodes_at(m, 1, -0.05), {}});
      finish(m);
      State state = initial_state(m);
      test::tangle_nodes(m, tangle, state.position);
      StaticSolver(m).solve(initial_controls(m), 1.0, {}, state);
      for (Index i = 0; i < m.node_count(); ++i) {
        EXPECT_LE((state.position[uz(i)] - m.rest_position[uz(i)]).norm(), 1e-5) << "node " << i;
      }
    }
  }
}

TEST(Static, RefusesABodyThatNothingHolds) {
  Material material;
  Model m = test::tissue_box(material, {2, 2, 2});
  finish(m);
  State state = initial_state(m);
  StaticSolver solver(m);
  EXPECT_THROW(solver.solve(initial_controls(m), 1.0, {}, state), Error);
  m.start_gravity = Vec3::Zero();  // but without forces it rests where it is
  StaticSolver weightless(m);
  EXPECT_EQ(weightless.solve(initial_controls(m), 1.0, {}, state).newton, 0);
}

TEST(Static, TangentSolveReachesItsTolerance) {
  Material material;
  material.poisson = 0.49;
  const Model m = bar(material, 3);
  StaticSolver solver(m);
  std::vector<Vec3> rhs(m.rest_position.size(), Vec3(0.0, -0.01, 0.0));
  std::vector<Vec3> u(rhs.size(), Vec3::Zero());
  solver.solve_tangent({m, initial_controls(m), m.rest_position}, rhs, 1e-8, u);
  std::vector<Vec3> Ku(rhs.size());
  test::tangent_times({m, initial_controls(m), m.rest_position}, 1.0, 0.0, u, Tangent::full, Ku);
  double error = 0.0, size = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    if (m.inverse_mass[i] == 0.0) continue;
    error += (Ku[i] - rhs[i]).squaredNorm();
    size += rhs[i].squaredNorm();
  }
  EXPECT_LE(std::sqrt(error / size), 2e-8);
}

}  // namespace
}  // namespace sinew
