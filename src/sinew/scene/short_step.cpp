#include "sinew/scene/step_cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "sinew/mesh/quality.h"

namespace sinew {
namespace {

constexpr double much_shorter = 30.0;  // than the step of the median tet
constexpr double long_run = 300.0;     // [s] of wall time
// Wall time of an explicit step on one core [s]: of itself, and for each tet.
constexpr double step_seconds = 5e-6;
constexpr double tet_seconds = 4e-8;

std::array<Vec3, 4> corners_of(const TetMesh& mesh, const Tet& t) {
  return {mesh.nodes[uz(t[0])], mesh.nodes[uz(t[1])], mesh.nodes[uz(t[2])], mesh.nodes[uz(t[3])]};
}

// The speed of pressure waves over that of shear waves [-].
double speed_ratio(const Material& m) {
  const double nu = std::min(m.poisson, 0.49);
  return std::sqrt(2.0 * (1.0 - nu) / (1.0 - 2.0 * nu));
}

// The least height of a tet over the speed of its pressure waves [s]. The largest frequency of a
// linear tet is near 2 c / height.
double wave_time(const std::array<Vec3, 4>& x, const Material& m) {
  double largest = 0.0;  // twice the area of a face
  for (std::size_t c = 0; c < 4; ++c) {
    const Vec3 &a = x[(c + 1) % 4], &b = x[(c + 2) % 4], &d = x[(c + 3) % 4];
    largest = std::max(largest, (b - a).cross(d - a).norm());
  }
  const double height = 6.0 * std::abs(signed_volume(x[0], x[1], x[2], x[3])) / largest;
  const double nu = std::min(m.poisson, 0.49);
  const double modulus = m.young * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
  return height / std::sqrt(modulus / m.density);
}

std::string wall_time(double seconds) {
  if (seconds < 7200.0) return fmt::format("{:.0f} minutes", seconds / 60.0);
  if (seconds < 172800.0) return fmt::format("{:.0f} hours", seconds / 3600.0);
  if (seconds < 8.6e7) return fmt::format("{:.0f} days", seconds / 86400.0);
  return fmt::format("{:.2g} years", seconds / 3.15e7);
}

}  // namespace

std::optional<std::string> step_warning(const Scene& scene, const PlacedBody& placed) {
  if (scene.stepper != StepperKind::verlet) return std::nullopt;
  const TetMesh& mesh = placed.mesh;
  std::map<int, const Material*> region;
  for (const SceneRegion& r : placed.body->regions)
    for (const int label : r.labels) region[label] = &r.material;
  const auto material = [&](std::size_t t) -> const Material& {
    const auto found = region.find(mesh.tet_label.empty() ? 0 : mesh.tet_label[t]);
    return found == region.end() ? placed.body->material : *found->second;
  };
  std::vector<double> times;
  std::size_t worst = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const Material& m = material(t);
    if (m.law == Law::uniform) return std::nullopt;
    times.push_back(wave_time(corners_of(mesh, mesh.tets[t]), m));
    if (times[t] < times[worst]) worst = t;
  }
  const double shortest = times[worst];
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  if (!(shortest > 0.0) || *middle < much_shorter * shortest) return std::nullopt;
  // A single flat tet shares its volume with its neighbours: its shear waves decide.
  const double step = shortest * speed_ratio(material(worst));
  const double steps = scene.duration / step;
  const double seconds =
      steps * (step_seconds + tet_seconds * static_cast<double>(mesh.tets.size()));
  if (seconds < long_run) return std::nullopt;
  const std::array<Vec3, 4> x = corners_of(mesh, mesh.tets[worst]);
  const Vec3 at = (x[0] + x[1] + x[2] + x[3]) / 4.0;
  return fmt::format(
      "tet {} (radius ratio {:.2g}, near ({:.4g}, {:.4g}, {:.4g}) m) makes explicit steps about "
      "{:.1g} s long, {:.1g} s without it: about {:.1g} steps and {} for {:g} s; repair = true of "
      "the body removes it, and stepper = \"implicit\" does not mind it",
      worst, radius_ratio(x), at.x(), at.y(), at.z(), step, *middle, steps, wall_time(seconds),
      scene.duration);
}

}  // namespace sinew
