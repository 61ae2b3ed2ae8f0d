#include "sinew/solver/limit_load.h"

#include <utility>

#include "sinew/base/error.h"

namespace sinew {
namespace {

constexpr int halves = 5;
// Of each search, see StaticOptions. All five then take at most about 10 s.
constexpr int most_newton = 100;
constexpr double most_work = 1e7;

bool stopped(const StaticOptions& options) {
  return options.stop != nullptr && options.stop->load();
}

Model with_loads(Model model, double share) {
  model.start_gravity *= share;
  for (Load& load : model.loads) {
    load.force *= share;
    load.traction *= share;
    load.pressure *= share;
  }
  return model;
}

// Moves `state` to rest under a share of the loads; without a rest state it keeps its place.
bool rests_under(const Model& model, Controls controls, double time, const StaticOptions& options,
                 double share, State& state) {
  const Model part = with_loads(model, share);
  controls.gravity *= share;
  State found = state;
  try {
    StaticSolver(part).solve(controls, time, options, found);
    state = std::move(found);
    return true;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::diverged) throw;
    return false;
  }
}

}  // namespace

LimitLoad find_limit_load(const Model& model, const Controls& controls, double time,
                          const StaticOptions& options, const State& start) {
  StaticOptions of_one = options;
  of_one.finds_limit_load = false;
  of_one.most_newton = most_newton;
  of_one.most_work = most_work;
  LimitLoad limit;
  State state = start;  // at rest under limit.rests, once there is one
  for (int n = 0; n < halves && !stopped(options); ++n) {
    const double share = 0.5 * (limit.rests + limit.fails);
    const bool rests = rests_under(model, controls, time, of_one, share, state);
    if (stopped(options)) break;
    (rests ? limit.rests : limit.fails) = share;
  }
  return limit;
}

}  // namespace sinew
