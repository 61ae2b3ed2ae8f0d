// What viscosity does to a body that swings: docs/methods/viscosity.md.
#include "sinew/forces/viscosity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "sinew/forces/terms.h"
#include "sinew/solver/implicit.h"
#include "sinew/solver/modes.h"
#include "sinew/solver/stable_step.h"
#include "sinew/solver/verlet.h"
#include "tests/support/effort.h"
#include "tests/support/forces.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

constexpr double pi = std::numbers::pi;

// A bar of 0.1 x 0.1 x 0.2 m, held at its end z = 0, without gravity.
Model short_bar(const Material& material, Index k) {
  BodySpec spec;
  spec.name = "bar";
  spec.mesh = beam(Vec3(0.1, 0.1, 0.2), {k, k, 2 * k});
  spec.materials = {material};
  spec.regions = {"all"};
  Model m;
  m.start_gravity = Vec3::Zero();
  add_body(m, spec);
  m.pins.push_back({"wall", test::nodes_at(m, 2, 0.0), {}});
  finish(m);
  return m;
}

Material viscous(double zeta) {
  Material m;
  m.damping = Damping::material;
  m.damping_ratio = zeta;
  return m;
}

// The lowest swing in torsion, which is all shear and carries no momentum.
std::vector<Vec3> torsion(const Model& m) {
  const Modes modes = lowest_modes(m, m.rest_position, 3);
  std::size_t best = 0;
  for (std::size_t k = 1; k < modes.shape.size(); ++k) {
    if (modes.participation[k].norm() < modes.participation[best].norm()) best = k;
  }
  return modes.shape[best];
}

struct Swing {
  double omega = 0.0;  // of the undamped swing [rad/s]
  double zeta = 0.0;   // damping ratio, from the decrement
};

// Lets the body swing freely from `shape` and measures two extremes a period apart.
Swing measure(const Model& m, const std::vector<Vec3>& shape, double h,
              const std::function<void(State&)>& step) {
  State s = initial_state(m);
  double largest = 0.0;
  for (const Vec3& u : shape) largest = std::max(largest, u.norm());
  for (std::size_t i = 0; i < shape.size(); ++i) s.position[i] += 1e-5 / largest * shape[i];
  std::vector<double> q;  // the share of the shape in the motion
  std::vector<double> time, extreme;
  while (extreme.size() < 3) {
    double sum = 0.0;
    for (std::size_t i = 0; i < shape.size(); ++i) {
      sum += m.mass[i] * shape[i].dot(s.position[i] - m.rest_position[i]);
    }
    q.push_back(sum);
    const std::size_t n = q.size();
    if (n >= 3 && (q[n - 2] - q[n - 3]) * (q[n - 1] - q[n - 2]) < 0.0) {
      const double slope = 0.5 * (q[n - 1] - q[n - 3]);  // the parabola through the last three
      const double bend = q[n - 1] - 2.0 * q[n - 2] + q[n - 3];
      time.push_back((static_cast<double>(n) - 2.0 - slope / bend) * h);
      extreme.push_back(q[n - 2] - 0.5 * slope * slope / bend);
    }
    step(s);
  }
  const double decrement = std::log(extreme[0] / extreme[2]);
  const double zeta = decrement / std::hypot(2.0 * pi, decrement);
  return {2.0 * pi / (time[2] - time[0]) / std::sqrt(1.0 - zeta * zeta), zeta};
}

Swing measure_implicit(const Model& m, const std::vector<Vec3>& shape, double h) {
  ImplicitStepper stepper(m);
  return measure(m, shape, h, [&](State& s) { stepper.step(h, initial_controls(m), {}, s); });
}

// zeta = eta omega / (2 mu) of every swing in shear, whatever the mesh.
TEST(Viscosity, DampsShearAlikeOnEveryMesh) {
  if (test::sanitized) return;  // hundreds of steps of what the other tests run, too
  const Material material = viscous(0.1);
  const double mu = shear_modulus(material.young, material.poisson);
  const double eta = material_viscosity(material, 0.2);
  std::vector<double> zetas;
  for (const Index k : {3, 4, 6}) {
    const Model m = short_bar(material, k);
    const Swing swing = measure_implicit(m, torsion(m), 0.02);
    EXPECT_NEAR(swing.zeta, eta * swing.omega / (2.0 * mu), 0.02 * swing.zeta) << k;
    zetas.push_back(swing.zeta / swing.omega);
  }
  EXPECT_NEAR(zetas.front(), zetas.back(), 0.02 * zetas.back());
}

TEST(Viscosity, IsTheSameToBothSteppers) {
  if (test::sanitized) return;  // thousands of steps of what the other tests run, too
  const Material material = viscous(0.2);
  const Model m = short_bar(material, 2);
  const std::vector<Vec3> shape = torsion(m);
  const Swing implicit = measure_implicit(m, shape, 0.004);
  VerletStepper explicit_stepper(m, Precision::double_);
  const double h =
      0.2 *
      find_stable_step(m, initial_controls(m), m.rest_position, explicit_stepper.forces()).step;
  const Swing verlet =
      measure(m, shape, h, [&](State& s) { explicit_stepper.step(h, initial_controls(m), s); });
  EXPECT_NEAR(implicit.zeta, verlet.zeta, 0.01 * verlet.zeta);
  EXPECT_NEAR(implicit.omega, verlet.omega, 0.01 * verlet.omega);
}

// A bar that falls under its own weight: what it loses is what the account says.
TEST(Viscosity, HeatIsInTheEnergyAccount) {
  Model m = short_bar(viscous(0.3), 2);
  m.start_gravity = Vec3(0.0, -9.81, 0.0);
  VerletStepper explicit_stepper(m, Precision::double_);
  const double stable =
      find_stable_step(m, initial_controls(m), m.rest_position, explicit_stepper.forces()).step;
  double drift[2];
  for (const int k : {0, 1}) {
    const double h = (k == 0 ? 0.4 : 0.2) * stable;
    State s = initial_state(m);
    while (s.time < test::effort(0.3)) explicit_stepper.step(h, initial_controls(m), s);
    const Energies e = test::energies_at(m, initial_controls(m), s);
    EXPECT_GT(e.dissipated, 0.05 * e.elastic);
    drift[k] = std::abs(e.total()) / e.dissipated;
  }
  EXPECT_LT(drift[1], 0.6 * drift[0]);  // dashpots are of first order in Verlet's step
  EXPECT_LT(drift[1], 0.05);
  ImplicitStepper stepper(m);
  State s = initial_state(m);
  for (int i = 0; i < test::effort(150); ++i) stepper.step(0.002, initial_controls(m), {}, s);
  const Energies e = test::energies_at(m, initial_controls(m), s);
  EXPECT_LT(std::abs(e.total()), 0.05 * e.dissipated);
}

TEST(Viscosity, LetsAFreeBodyTurn) {  // a spin about a main axis goes on
  Model m = test::tissue_box(viscous(1.0), {2, 2, 2});
  m.start_gravity = Vec3::Zero();
  finish(m);
  State s = initial_state(m);
  for (std::size_t i = 0; i < s.position.size(); ++i) {
    s.half_velocity[i] = Vec3(0, 0, 2.0).cross(s.position[i]);
  }
  const auto spin = [&] {
    Vec3 l = Vec3::Zero();
    for (std::size_t i = 0; i < s.position.size(); ++i) {
      l += m.mass[i] * s.position[i].cross(s.half_velocity[i]);
    }
    return l.z();
  };
  const double before = spin();
  VerletStepper explicit_stepper(m, Precision::double_);
  const double h =
      0.5 *
      find_stable_step(m, initial_controls(m), m.rest_position, explicit_stepper.forces()).step;
  for (int i = 0; i < test::effort(2000); ++i) explicit_stepper.step(h, initial_controls(m), s);
  EXPECT_NEAR(spin(), before, 1e-3 * before);
}

}  // namespace
}  // namespace sinew
