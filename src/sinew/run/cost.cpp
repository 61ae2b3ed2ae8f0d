#include "sinew/run/cost.h"

#include <fmt/format.h>

#include "sinew/base/clock.h"

namespace sinew {
namespace {

constexpr double a_day = 86400.0;  // [s]
constexpr double a_while = 1.0;    // [s] steps of a flat tet get shorter still as it deforms
// The cost of a step in evaluations of the forces: an explicit one with its estimates of the stable
// step; of an implicit one a small number of Newton steps.
constexpr double explicit_step = 1.3;
constexpr double implicit_step = 30.0;

double steps_left(const sim::World& world) {
  const RunState& run = world.run();
  if (run.stepper == StepperKind::rest || !(run.target_step > 0.0)) return 0.0;
  return (world.scene().duration - run.state.time) / run.target_step;
}

// [s]
double cost_of_step(sim::World& world) {
  ForceEvaluator& forces = world.stepping().forces();
  forces.evaluate(world.controls(), world.state());  // the first one finds cold memory
  const Clock::time_point start = Clock::now();
  forces.evaluate(world.controls(), world.state());
  return seconds_since(start) *
         (world.run().stepper == StepperKind::implicit ? implicit_step : explicit_step);
}

std::string time_text(double seconds) {
  constexpr double an_hour = 3600.0;
  constexpr double a_year = 365.0 * a_day;
  if (seconds < 120.0) return fmt::format("{:.2g} s", seconds);
  if (seconds < 2.0 * an_hour) return fmt::format("{:.3g} minutes", seconds / 60.0);
  if (seconds < 2.0 * a_day) return fmt::format("{:.3g} hours", seconds / an_hour);
  return seconds < 2.0 * a_year ? fmt::format("{:.3g} days", seconds / a_day)
                                : fmt::format("{:.3g} years", seconds / a_year);
}

// The bad tet that makes the steps short; null: something else does.
const ShortStep* bad_tet(const sim::World& world) {
  constexpr double much = 0.1;  // of its wave time: steps below are short for another reason
  if (world.scene().dt || world.run().stepper != StepperKind::verlet) return nullptr;
  const ShortStep* worst = nullptr;
  for (const BuildReport::Body& body : world.report().bodies)
    if (body.short_step && (worst == nullptr || body.short_step->wave_time < worst->wave_time))
      worst = &*body.short_step;
  return worst != nullptr && world.run().target_step > much * worst->wave_time ? worst : nullptr;
}

// The reason of the steps' length, and the remedy.
std::string reason(const sim::World& world) {
  if (const ShortStep* bad = bad_tet(world)) return bad->reason;
  const std::string& by = world.stepping().limited_by();
  return fmt::format(
      "{}; take a longer step, a softer material, a coarser or better mesh (sinew info), or a "
      "shorter duration",
      world.scene().dt ? "the scene gives this step"
      : by.empty()     ? "the stable step allows no longer one"
                       : by);
}

}  // namespace

double estimate_cost(sim::World& world) {
  const double steps = steps_left(world);
  return steps > 0.0 ? steps * cost_of_step(world) : 0.0;
}

std::optional<std::string> cost_warning(sim::World& world) {
  const double cost = estimate_cost(world);
  if (!(cost > (bad_tet(world) != nullptr ? a_while : a_day))) return std::nullopt;
  const double steps = steps_left(world);
  return fmt::format(
      "this run would take at least {}: {:.3g} steps of {:.3g} s at {:.2g} s each; {}",
      time_text(cost), steps, world.run().target_step, cost / steps, reason(world));
}

}  // namespace sinew
