// The counters of a run in one list, from which checkpoint, summary, JSON and live status derive. A
// new counter is one line of the list, and the code that computes its value.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string_view>

#include "sinew/solver/stepper.h"

namespace sinew {

// X(type, name, value after a step, key in summary.json, unit and meaning). In the third column c
// is the value so far and r the StepReport; a lone c is counted elsewhere. A key may be a path
// "table/key"; a counter without a key is not in summary.json.
//
// clang-format off
#define SINEW_RUN_COUNTERS(X)                                                                      \
  X(std::int64_t, newton_steps, c + r.newton, "static/newton_steps", "Newton steps of implicit steps and rest states") \
  X(std::int64_t, products, c + r.products, "static/products", "Hessian products that they took")  \
  X(double, residual, std::max(c, r.residual), "static/residual", "the largest that a step left [-]") \
  X(std::int64_t, step_cuts, c + r.cuts, "step_cuts", "times that an implicit step was cut in half") \
  X(std::int64_t, steps_cut_short, c + (r.ran_out ? 1 : 0), "", "steps that budget_ms ended")      \
  X(std::int64_t, step_reductions, c, "step_reductions", "times that the step was made shorter")   \
  X(std::int64_t, step_increases, c, "step_increases", "times that it was made longer again")      \
  X(std::int64_t, recovery_steps, c + (r.recovered > 0 ? 1 : 0), "recovery_steps", "steps with inversion recovery") \
  X(double, recovery_work, c + r.recovery_work, "recovery_work", "work of inversion recovery, part of work_in [J]") \
  X(double, led_out_work, c + r.led_out, "led_out_work", "work of contacts and limits that lead back to their bounds, part of work_in [J]") \
  X(std::int64_t, contacts, r.contacts, "contacts", "places that touched in the last step")        \
  X(double, deepest, std::max(c, r.deepest), "deepest_penetration", "of all steps [m]")            \
  X(double, depth, r.deepest, "penetration", "of the last step [m]")                               \
  X(double, friction_work, c + r.friction, "friction_work", "turned to heat by contacts [J]")      \
  X(std::int64_t, limit_sweeps, c + r.limit_sweeps, "limits/sweeps", "sweeps over limited springs") \
  X(std::int64_t, unmet_limits, c + (r.limits_met ? 0 : 1), "limits/unmet_steps", "steps that ended with a limit violated") \
  X(double, peak_energy, c, "energy/peak", "largest entry of the energy account at the end of any frame [J]") \
  X(double, peak_drift, c, "energy/peak_drift", "largest change of its total [J]")                 \
  X(std::int64_t, peak_inverted_tets, c, "peak_inverted_tets", "the most at the end of any frame") \
  X(double, peak_stretch, c, "peak_stretch", "largest of all frames [-]")                          \
  X(double, peak_compress, c, "peak_compress", "largest of all frames [-]")
// clang-format on

struct RunCounters {
#define SINEW_COUNTER_MEMBER(type, name, after, key, meaning) type name{};
  SINEW_RUN_COUNTERS(SINEW_COUNTER_MEMBER)
#undef SINEW_COUNTER_MEMBER

  // Adds the report of a step.
  void add(const StepReport& r) {
#define SINEW_COUNTER_ADD(type, name, after, key, meaning) \
  {                                                        \
    [[maybe_unused]] const type c = name;                  \
    name = after;                                          \
  }
    SINEW_RUN_COUNTERS(SINEW_COUNTER_ADD)
#undef SINEW_COUNTER_ADD
  }
};

struct CounterField {
  std::string_view name;     // as in RunCounters and in the live view's protocol
  std::string_view key;      // in summary.json; empty: not in it
  std::string_view meaning;  // with its unit
};

// Calls visit(field, value) for every counter in the list's order. The value can be written unless
// `counters` is const.
template <typename Counters, typename Visit>
void for_each_counter(Counters& counters, Visit&& visit) {
#define SINEW_COUNTER_VISIT(type, name, after, key, meaning) \
  visit(CounterField{#name, key, meaning}, counters.name);
  SINEW_RUN_COUNTERS(SINEW_COUNTER_VISIT)
#undef SINEW_COUNTER_VISIT
}

}  // namespace sinew
