#include "sinew/identify/calibrate.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "sinew/base/error.h"
#include "sinew/identify/moduli.h"

namespace sinew {
namespace {

Moduli with_volume(const TetMesh& mesh, double poisson, double volume) {
  BodySpec body;
  body.name = "mesh";
  body.mesh = mesh;
  Material m;
  m.law = Law::calibrated;
  m.young = 1.0;
  m.poisson = poisson;
  m.volume_stiffness = volume;
  m.damping_ratio = 0.0;
  body.materials = {m};
  body.regions = {"all"};
  return moduli_of(measure_stiffness(body, TestKind::traction, 1e-6));
}

// Ratio of the bulk to the shear modulus for nu: K / G = 2 (1 + nu) / (3 (1 - 2 nu)).
double bulk_over_shear(double poisson) {
  return 2.0 * (1.0 + poisson) / (3.0 * (1.0 - 2.0 * poisson));
}

}  // namespace

Calibration calibrate(const TetMesh& mesh, double poisson) {
  Calibration result;
  Moduli m = with_volume(mesh, poisson, 0.0);
  result.tests = 1;
  result.smallest_poisson = m.poisson;
  if (poisson < m.poisson) {
    throw Error(
        ErrorKind::input,
        fmt::format("law 'calibrated' cannot have Poisson's ratio {:.3g}: its springs alone "
                    "have {:.3g} on this mesh, and volume only adds to that",
                    poisson, m.poisson),
        "a larger 'poisson', or law = \"neo-hookean\"");
  }
  // K/G grows almost linearly with kappa: secant steps on it, starting from the springs alone.
  const double goal = bulk_over_shear(poisson);
  double before = 0.0;
  double value_before = m.bulk / m.shear;
  double kappa = (goal - value_before) * m.shear;
  while (result.tests < 20 && kappa > 0.0) {
    m = with_volume(mesh, poisson, kappa);
    ++result.tests;
    const double value = m.bulk / m.shear;
    if (std::abs(m.poisson - poisson) <= 1e-5 || value == value_before) break;
    const double next = kappa + (goal - value) * (kappa - before) / (value - value_before);
    before = kappa;
    value_before = value;
    kappa = std::max(next, 0.1 * kappa);
  }
  result.spring_scale = 1.0 / m.young;
  result.volume_share = kappa / m.young;
  return result;
}

void calibrate_materials(BodySpec& body) {
  std::map<double, Calibration> known;  // by Poisson's ratio
  for (Material& m : body.materials) {
    if (m.law != Law::calibrated || m.volume_stiffness >= 0.0) continue;
    auto found = known.find(m.poisson);
    if (found == known.end())
      found = known.emplace(m.poisson, calibrate(body.mesh, m.poisson)).first;
    m.spring_scale = found->second.spring_scale;
    m.volume_stiffness = found->second.volume_share * m.young;
  }
}

}  // namespace sinew
