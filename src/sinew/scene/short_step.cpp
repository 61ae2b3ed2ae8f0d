#include "sinew/scene/short_step.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "sinew/mesh/doctor.h"
#include "sinew/mesh/quality.h"
#include "sinew/scene/place.h"
#include "sinew/scene/regions.h"

namespace sinew {
namespace {

constexpr double much_shorter = 30.0;  // than the step of the median tet

std::array<Vec3, 4> corners_of(const TetMesh& mesh, const Tet& t) {
  return {mesh.nodes[uz(t[0])], mesh.nodes[uz(t[1])], mesh.nodes[uz(t[2])], mesh.nodes[uz(t[3])]};
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
  return height / pressure_wave_speed(m);
}

}  // namespace

std::optional<ShortStep> find_short_step(const PlacedBody& placed) {
  const TetMesh& mesh = placed.mesh;
  const std::vector<int> region = regions_of_tets(placed);
  const auto material = [&](std::size_t t) -> const Material& {
    return region[t] < 0 ? placed.body->material : placed.body->regions[uz(region[t])].material;
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
  const std::array<Vec3, 4> x = corners_of(mesh, mesh.tets[worst]);
  if (!(radius_ratio(x) < kNearFlat)) return std::nullopt;  // small or stiff: no fault
  const Vec3 at = (x[0] + x[1] + x[2] + x[3]) / 4.0;
  return ShortStep{
      shortest,
      fmt::format("tet {} of body {} (radius ratio {:.2g}, near ({:.4g}, {:.4g}, {:.4g}) m) makes "
                  "them that short, without it they would be about {:.1g} s; repair = true of the "
                  "body removes it, and stepper = \"implicit\" does not mind it",
                  worst, placed.body->name, radius_ratio(x), at.x(), at.y(), at.z(), *middle)};
}

}  // namespace sinew
