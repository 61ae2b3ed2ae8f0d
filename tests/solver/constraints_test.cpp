#include "sinew/solver/constraints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sinew/base/parallel.h"
#include "sinew/base/random.h"
#include "sinew/forces/limits.h"
#include "sinew/forces/stiffness.h"
#include "sinew/forces/terms.h"
#include "sinew/forces/volume.h"
#include "sinew/solver/bound.h"
#include "sinew/solver/implicit.h"
#include "tests/support/effort.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

using test::point_masses;
using test::tissue_box;

constexpr double frame = 1.0 / 60.0;

Material soft(double young = 2e4, double poisson = 0.4) {
  Material material;
  material.young = young;
  material.poisson = poisson;
  material.damping_ratio = 0.1;
  return material;
}

// A box of 0.1 m whose lowest nodes are `height` above the ground y = 0.
Model box_above_ground(const Material& material, double height, double friction, int cells = 2) {
  Model m = tissue_box(material, {cells, cells, cells});
  m.ground = Ground{Vec3(0, -0.05 - height, 0), Vec3::UnitY(), 0.0, friction};
  finish(m);
  return m;
}

double lowest(const Model& m, const State& s) {
  double low = no_limit;
  for (Index i = 0; i < m.body_node_count(); ++i) {
    low = std::min(low, m.ground->normal.dot(s.position[uz(i)] - m.ground->point));
  }
  return low;
}

double weight(const Model& m) {
  double mass = 0.0;
  for (const double x : m.mass) mass += x;
  return mass * m.gravity.norm();
}

// --- the formulas ---

TEST(Bound, PullIsTheDerivativeOfTheEnergy) {
  for (const double q : {-0.3, -0.01, 0.5, 1.02, 1.4}) {
    for (const double p : {-2.0, 0.0, 3.0}) {
      const double e = 1e-6, k = 7.0;
      const auto energy = [&](double x) { return bound_energy(x, 0.0, 1.0, k, p); };
      const auto pull = [&](double x) { return bound_pull(x, 0.0, 1.0, k, p); };
      EXPECT_NEAR(pull(q), (energy(q + e) - energy(q - e)) / (2 * e), 1e-7);
      EXPECT_NEAR(bound_stiffness(q, 0.0, 1.0, k, p), (pull(q + e) - pull(q - e)) / (2 * e), 1e-7);
    }
  }
}

TEST(Bound, FrictionIsTheDerivativeOfItsEnergyAndAtMostItsShareOfThePush) {
  const Vec3 n = Vec3(1, 2, 2) / 3.0;
  const Vec3 a = Vec3(2, 1, -2) / 3.0, b = n.cross(a);
  const double k = 50.0, r = 0.7, e = 1e-6;
  const Vec3 p = 0.2 * a - 0.3 * b;
  for (const Vec3& u : {Vec3(0.001 * a), Vec3(0.1 * a - 0.04 * b), Vec3(-0.5 * b)}) {
    const Vec3 s = friction_pull(u, r, k, p);
    EXPECT_LE(s.norm(), r * (1 + 1e-12));
    const Mat3 block = friction_stiffness(u, r, k, p, n);
    for (const Vec3& d : {a, b}) {
      EXPECT_NEAR(
          s.dot(d),
          (friction_energy(u + e * d, r, k, p) - friction_energy(u - e * d, r, k, p)) / (2 * e),
          1e-7);
      const Vec3 change =
          (friction_pull(u + e * d, r, k, p) - friction_pull(u - e * d, r, k, p)) / (2 * e);
      EXPECT_LE((block * d - change).norm(), 1e-6);
    }
    EXPECT_LE((block * n).norm(), 1e-12);
  }
}

// --- the energies on a body ---

// A crumpled box in which every kind of condition pulls, each with a multiplier.
struct Crumpled {
  Model model = tissue_box(soft(), {2, 2, 2});
  State state;
  std::vector<Vec3> from;

  Crumpled() {
    model.ground = Ground{Vec3(0, -0.03, 0), Vec3(0.1, 1, 0).normalized(), 0.0, 0.5};
    for (std::size_t s = 0; s < model.springs.size(); ++s) {
      model.stretch_limit[s] = model.compress_limit[s] = 0.05;
    }
    std::fill(model.volume_limit.begin(), model.volume_limit.end(), 0.05);
    model.pins.push_back({"top", test::nodes_at(model, 1, 0.05), {}});
    finish(model);
    state = initial_state(model);
    from = state.position;
    for (std::size_t i = 0; i < from.size(); ++i) {
      state.position[i] += 0.01 * (random_point(i) - Vec3::Constant(0.5));
    }
    state.reactions.ground.assign(from.size(), Vec3(0.02, 0.2, 0.03));
    state.reactions.tension.assign(model.limited.size(), 0.3);
    state.reactions.pressure.assign(model.cell_volume.size(), -40.0);
  }
};

TEST(Constraints, ForceAndTangentAreTheDerivativesOfTheEnergy) {
  Crumpled c;
  ASSERT_GT(c.model.limited.size(), 20U);
  ASSERT_TRUE(c.model.has_volume_limit);
  Workspace workspace(c.model);
  Constraints constraints(c.model, 3600.0, 60.0, true);
  constraints.start(c.state, &c.from);
  std::vector<Vec3> u(c.from.size());
  for (std::size_t i = 0; i < u.size(); ++i) {
    u[i] = random_point(1000 + i) - Vec3::Constant(0.5);
    if (c.model.inverse_mass[i] == 0.0) u[i].setZero();
  }
  const auto at = [&](double e) {
    std::vector<Vec3> x = c.state.position;
    for (std::size_t i = 0; i < u.size(); ++i) x[i] += e * u[i];
    prepare_stiffness(c.model, x, workspace);
    return x;
  };
  const auto energy = [&](double e) { return constraints.value(at(e), workspace); };
  const auto force = [&](double e) {
    const std::vector<Vec3> x = at(e);
    std::vector<Vec3> f(x.size(), Vec3::Zero());
    constraints.add_forces(x, workspace, f);
    return f;
  };
  const double e = 1e-7;
  double slope = 0.0;
  const std::vector<Vec3> f = force(0.0);
  for (std::size_t i = 0; i < u.size(); ++i) slope -= f[i].dot(u[i]);
  EXPECT_NEAR(slope, (energy(e) - energy(-e)) / (2 * e), 1e-5 * std::abs(slope));

  // The product takes the curvature of the volumes from the material's own: with and without.
  std::vector<Vec3> with(u.size()), without(u.size());
  const std::vector<Vec3> x = at(0.0);
  stiffness_damping_times(c.model, x, 1.0, 0.0, u, Tangent::full, workspace, without);
  constraints.linearise(x, workspace);
  stiffness_damping_times(c.model, x, 1.0, 0.0, u, Tangent::full, workspace, with);
  constraints.add_stiffness_times(u, workspace, with);
  const std::vector<Vec3> plus = force(e), minus = force(-e);
  double error = 0.0, size = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    if (c.model.inverse_mass[i] == 0.0) continue;
    const Vec3 change = -(plus[i] - minus[i]) / (2 * e);
    error += (with[i] - without[i] - change).squaredNorm();
    size += change.squaredNorm();
  }
  EXPECT_LE(std::sqrt(error / size), 1e-4);
}

// --- steps ---

TEST(Constraints, ADroppedBoxComesToRestOnTheGround) {
  for (const double young : {1e4, 1e6, 1e9}) {
    if (test::sanitized && young != 1e6) continue;
    Material material = soft(young);
    material.drag = 2.0;
    const Model m = box_above_ground(material, 0.02, 0.5);
    State s = initial_state(m);
    Workspace workspace(m);
    ImplicitStepper stepper(m);
    const double start = measure_energies(m, s, workspace).kinetic;
    double before = start;
    for (int i = 0; i < 150; ++i) {
      const ImplicitReport report = stepper.step(frame, {}, s);
      EXPECT_TRUE(report.within);
      EXPECT_GE(lowest(m, s), -1e-3 * 0.05);
      const Energies e = measure_energies(m, s, workspace);
      const double mechanical = e.kinetic + e.elastic + e.gravity;
      EXPECT_LE(mechanical, before + 1e-6 * weight(m) * 0.02) << young << " step " << i;
      before = mechanical;
    }
    EXPECT_NEAR(lowest(m, s), 0.0, 1e-4 * 0.05);
    Vec3 push = Vec3::Zero();
    double speed = 0.0;
    for (const Vec3& p : s.reactions.ground) push += p;
    for (const Vec3& v : s.half_velocity) speed = std::max(speed, v.norm());
    EXPECT_LE(speed, 1e-3);
    EXPECT_NEAR(push.y(), weight(m), 1e-3 * weight(m));
    EXPECT_LE(std::hypot(push.x(), push.z()), 1e-3 * weight(m));
  }
}

}  // namespace
}  // namespace sinew
