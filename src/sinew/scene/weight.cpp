#include "sinew/scene/weight.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sinew {
namespace {

constexpr double too_heavy = 5.0;  // rho g l / E: the body cannot keep its shape
constexpr double light = 0.1;      // a twentieth shorter under its own weight; withstands falls too

// 1, 2 or 5 times a power of ten, not below x > 0.
double round_number_above(double x) {
  const double unit = std::pow(10.0, std::floor(std::log10(x)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * unit >= x) return digit * unit;
  }
  return 10.0 * unit;
}

bool is_pinned(const Scene& scene, const SceneBody& body) {
  return std::any_of(scene.pins.begin(), scene.pins.end(),
                     [&](const ScenePin& pin) { return pin.body == body.name && pin.select.all; });
}

}  // namespace

std::optional<std::string> weight_warning(const Scene& scene, const PlacedBody& placed) {
  const SceneBody& body = *placed.body;
  const double g = scene.gravity.norm();
  if (g == 0.0 || is_pinned(scene, body)) return std::nullopt;
  double young = body.material.young;
  double density = body.material.density;
  bool known = body.material.law != Law::uniform;
  for (const SceneRegion& region : body.regions) {
    young = std::max(young, region.material.young);  // the stiffest may hold up the rest
    density = std::min(density, region.material.density);
    known = known && region.material.law != Law::uniform;
  }
  const Vec3 down = scene.gravity / g;
  double low = 0.0;
  double high = 0.0;
  for (std::size_t i = 0; i < placed.mesh.nodes.size(); ++i) {
    const double along = down.dot(placed.mesh.nodes[i]);
    low = i == 0 ? along : std::min(low, along);
    high = i == 0 ? along : std::max(high, along);
  }
  const double pressure = density * g * (high - low);
  if (!known || !(pressure > too_heavy * young)) return std::nullopt;
  return fmt::format(
      "far too soft for its weight: density x gravity x height = {:.3g} Pa is {:.2g} times its "
      "Young's modulus, {:.3g} Pa, so it cannot keep its shape and goes flat; --set "
      "{}.young={:.0e} "
      "would bear it",
      pressure, pressure / young, young, body.name, round_number_above(pressure / light));
}

}  // namespace sinew
