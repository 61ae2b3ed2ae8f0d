#include "sinew/identify/identify.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "sinew/base/clock.h"
#include "sinew/base/error.h"
#include "sinew/base/text.h"
#include "sinew/forces/terms.h"
#include "sinew/identify/calibrate.h"
#include "sinew/mesh/surface.h"
#include "sinew/model/material_words.h"
#include "sinew/solver/stable_step.h"
#include "sinew/solver/static.h"
#include "sinew/solver/verlet.h"

namespace sinew {
namespace {

// A law that can be identified, with the material values that define it.
struct IdentifiableLaw {
  std::string_view name;
  Law law = Law::neo_hookean;
  double beta = default_beta;
  Volume volume = Volume::by_law;
};

constexpr std::array<IdentifiableLaw, 5> identifiable = {
    {{word_of(Law::neo_hookean)},
     {"linear-fem", Law::neo_hookean, 1.0, Volume::tet},
     {word_of(Law::calibrated), Law::calibrated},
     {word_of(Law::lloyd), Law::lloyd},
     {word_of(Law::vangelder), Law::vangelder}}};

Material material_of(const AskedMaterial& asked, const IdentifiableLaw& law) {
  Material m;
  m.young = asked.young;
  m.poisson = asked.poisson;
  m.density = asked.density;
  m.damping_ratio = asked.damping_ratio;
  m.law = law.law;
  m.beta = law.beta;
  m.volume = law.volume;
  return m;
}

Model free_body(const BodySpec& body) {
  Model m;
  m.start_gravity = Vec3::Zero();
  add_body(m, body);
  return m;
}

// Median wall time of a step of the body at rest [s].
double time_of_step(const Model& model, double h) {
  VerletStepper stepper(model, Precision::double_);
  State state = initial_state(model);
  std::vector<double> times;
  for (int k = 0; k < 25; ++k) {
    const Clock::time_point start = Clock::now();
    stepper.step(h, initial_controls(model), state);
    times.push_back(seconds_since(start));
  }
  std::nth_element(times.begin(), times.begin() + 12, times.end());
  return times[12];
}

// Lateral stretch and P_zz of the stable neo-Hookean material at the stretch l along z with free
// sides: P_xx = mu t + (kappa (J - 1) - mu) l t = 0 with J = l t^2 gives t in closed form.
struct Uniaxial {
  double lateral = 1.0;
  double stress = 0.0;
};
Uniaxial uniaxial(double young, double poisson, double l) {
  const double mu = shear_modulus(young, poisson);
  const double kappa = lame_lambda(young, poisson) + mu;
  const double t2 = (mu * (l - 1.0) + kappa * l) / (kappa * l * l);
  return {std::sqrt(t2), mu * l + (kappa * (l * t2 - 1.0) - mu) * t2};
}

StressCurve measure_curve(const BodySpec& body, const AskedMaterial& asked) {
  StressCurve curve;
  Model model = free_body(body);
  Pin surface{"surface", {}, {}};
  std::vector<char> on(model.rest_position.size(), 0);
  for (const Triangle& t : build_surface(body.mesh.tets, body.mesh.node_count()).triangles) {
    for (const Index corner : t) on[uz(corner)] = 1;
  }
  for (Index i = 0; i < model.node_count(); ++i) {
    if (on[uz(i)] != 0) surface.nodes.push_back(i);
  }
  KeyFrame key;
  key.time = 1.0;
  surface.path.keys = {key};
  model.pins.push_back(surface);
  finish(model);
  for (const double l : {0.7, 0.8, 0.9, 1.0, 1.1, 1.2, 1.3}) {
    const Uniaxial expected = uniaxial(asked.young, asked.poisson, l);
    curve.stretch.push_back(l);
    curve.expected.push_back(expected.stress);
    model.pins[0].path.keys[0].deform =
        Vec3(expected.lateral, expected.lateral, l).asDiagonal().toDenseMatrix();
    State state = initial_state(model);
    StaticSolver solver(model);
    StaticOptions options;
    options.tolerance = 1e-4;
    double stress = std::numeric_limits<double>::quiet_NaN();
    try {
      solver.solve(initial_controls(model), 1.0, options, state);
      const Field& force = solver.forces().evaluate(initial_controls(model), state).force;
      stress = 0.0;
      for (const Index i : surface.nodes) {
        stress -= force[uz(i)].z() * model.rest_position[uz(i)].z();
      }
      stress /= model.bodies[0].rest_volume;
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::diverged) throw;
    }
    curve.stress.push_back(stress);
  }
  return curve;
}

}  // namespace

std::vector<std::string> identifiable_laws() {
  std::vector<std::string> names;
  for (const IdentifiableLaw& law : identifiable) names.emplace_back(law.name);
  return names;
}

LawIdentity identify_law(const TetMesh& mesh, const AskedMaterial& asked, const std::string& law,
                         bool with_curve) {
  const auto known =
      std::find_if(identifiable.begin(), identifiable.end(),
                   [&](const IdentifiableLaw& candidate) { return candidate.name == law; });
  if (known == identifiable.end()) {
    throw Error(ErrorKind::usage, fmt::format("'{}' is no law that can be identified", law),
                fmt::format("one of: all, {}", fmt::join(identifiable_laws(), ", ")));
  }
  LawIdentity identity;
  identity.law = law;
  BodySpec body;
  body.name = "mesh";
  body.mesh = mesh;
  body.materials = {material_of(asked, *known)};
  body.regions = {"all"};
  try {
    calibrate_materials(body);
    identity.traction = moduli_of(measure_stiffness(body, TestKind::traction));
    identity.displacement = moduli_of(measure_stiffness(body, TestKind::displacement));
  } catch (const Error& error) {
    identity.note = error.message();
    return identity;
  }
  Model model = free_body(body);
  finish(model);
  ForceEvaluator forces(model, Precision::double_);
  identity.stable_step =
      find_stable_step(model, initial_controls(model), model.rest_position, forces).step;
  identity.step_seconds = time_of_step(model, 0.5 * identity.stable_step);
  if (with_curve) identity.curve = measure_curve(body, asked);
  return identity;
}

}  // namespace sinew
