#include "sinew/sim/stepping_options.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sinew {

double SteppingOptions::first_length(const FirstStep& first) const {
  if (dt) return given();
  if (budget) return interval;
  return std::min({safety * first.stable, first.longest, interval});
}

SteppingOptions stepping_options(const Scene& scene) {
  SteppingOptions o;
  o.stepper = scene.stepper;
  o.method = {scene.scheme, scene.tolerance, scene.precision};
  o.dt = scene.dt;
  o.substeps = scene.substeps;
  o.safety = scene.safety;
  o.allow_unstable = scene.allow_unstable;
  o.duration = scene.duration;
  o.interval = 1.0 / scene.output.fps;
  if (scene.budget_ms) o.budget = 1e-3 * *scene.budget_ms;
  o.file = scene.file;
  return o;
}

std::int64_t count_parts(double whole, double part) {
  return std::max<std::int64_t>(1,
                                static_cast<std::int64_t>(std::ceil(whole / part * (1.0 - 1e-12))));
}

std::int64_t count_frames(double duration, double interval) {
  if (!(duration < no_limit)) return std::numeric_limits<std::int64_t>::max();
  return count_parts(duration, interval);
}

}  // namespace sinew
