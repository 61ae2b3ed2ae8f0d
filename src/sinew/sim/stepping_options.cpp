#include "sinew/sim/stepping_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "sinew/base/error.h"

namespace sinew {

double SteppingOptions::first_length(const FirstStep& first) const {
  if (dt) return given();
  if (budget) return interval;
  return std::min({safety * first.stable, first.longest, interval});
}

SteppingOptions stepping_options(const Scene& scene) {
  SteppingOptions o;
  o.stepper = scene.stepper;
  o.method = {scene.scheme, tolerance_of(scene), scene.precision};
  o.dt = scene.dt;
  o.substeps = scene.substeps;
  o.safety = scene.safety;
  o.allow_unstable = scene.allow_unstable;
  o.duration = scene.duration;
  o.interval = 1.0 / scene.output.fps;
  if (scene.budget_ms) o.budget = 1e-3 * *scene.budget_ms;
  o.file = scene.file;
  o.cuts_later = std::any_of(scene.cuts.begin(), scene.cuts.end(), [](const SceneCut& cut) {
    return cut.time > 0.0 || (!cut.blade.empty() && cut.blade.back().time > 0.0);
  });
  return o;
}

std::int64_t count_parts(double whole, double part) {
  constexpr double most = 9007199254740992.0;  // 2^53: a double counts up to here, one by one
  const double parts = std::ceil(whole / part * (1.0 - 1e-12));
  if (!(parts <= most))
    throw Error(ErrorKind::input,
                fmt::format("{:g} s in steps of {:g} s would take {:.3g} steps, more than can be "
                            "counted",
                            whole, part, parts),
                "a longer step (dt, or dt = \"auto\", with fewer substeps), a softer material or a "
                "coarser mesh, or a shorter duration");
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(parts));
}

std::int64_t count_frames(double duration, double interval) {
  if (!(duration < no_limit)) return std::numeric_limits<std::int64_t>::max();
  return count_parts(duration, interval);
}

}  // namespace sinew
