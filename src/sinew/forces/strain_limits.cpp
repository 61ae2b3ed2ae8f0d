#include "sinew/forces/strain_limits.h"

#include <algorithm>
#include <cmath>

#include "sinew/base/parallel.h"

namespace sinew {
namespace {

// The allowed length that is nearest to `length`.
double allowed_length(const Model& model, std::size_t s, double length) {
  const double l0 = model.rest_length[s];
  const double longest = (1.0 + model.stretch_limit[s]) * l0;
  const double shortest =
      model.compress_limit[s] < no_limit ? (1.0 - model.compress_limit[s]) * l0 : 0.0;
  return std::clamp(length, shortest, longest);
}

LimitSweep project(const Model& model, std::size_t s, std::vector<Vec3>& x) {
  const auto i = uz(model.springs[s][0]);
  const auto j = uz(model.springs[s][1]);
  const Vec3 x_ij = x[j] - x[i];
  const double length = x_ij.norm();
  const double excess = length - allowed_length(model, s, length);
  const bool over = std::abs(excess) > model.limit_tolerance * model.rest_length[s];
  const bool exact = model.stretch_limit[s] == 0.0 && excess != 0.0;
  if (length == 0.0 || !(over || exact)) return {};
  const double w_i = model.inverse_mass[i];
  const double w_j = model.inverse_mass[j];
  const Vec3 correction = (excess / (length * (w_i + w_j))) * x_ij;
  x[i] += w_i * correction;
  x[j] -= w_j * correction;
  return {1, over ? 1 : 0};
}

}  // namespace

LimitSweep sweep_limits(const Model& model, std::vector<Vec3>& x) {
  const auto sum = [](const LimitSweep& a, const LimitSweep& b) {
    return LimitSweep{a.moved + b.moved, a.over + b.over};
  };
  LimitSweep done;
  for (std::size_t c = 0; c + 1 < model.colour_start.size(); ++c) {
    const Index first = model.colour_start[c];
    const LimitSweep colour = parallel_reduce(
        model.colour_start[c + 1] - first, LimitSweep{},
        [&](Range r) {
          LimitSweep count;
          for (Index k = r.begin; k < r.end; ++k) {
            count = sum(count, project(model, uz(model.limited[uz(first + k)]), x));
          }
          return count;
        },
        sum);
    done = sum(done, colour);
  }
  return done;
}

double measure_limit_violation(const Model& model, const std::vector<Vec3>& x) {
  double worst = 0.0;
  for (const Index spring : model.limited) {
    const auto s = uz(spring);
    const double length = (x[uz(model.springs[s][1])] - x[uz(model.springs[s][0])]).norm();
    worst =
        std::max(worst, std::abs(length - allowed_length(model, s, length)) / model.rest_length[s]);
  }
  return worst;
}

}  // namespace sinew
