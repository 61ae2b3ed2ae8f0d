// stepper = "verlet": explicit steps; the longest stable step is estimated again as the body
// deforms.
#include <algorithm>
#include <cmath>

#include "sinew/solver/stable_step.h"
#include "sinew/solver/stepper.h"
#include "sinew/solver/verlet.h"

namespace sinew {
namespace {

// Steps between two estimates of the stable step. An estimate costs about as much as two steps in
// double precision, or five in single. The interval grows from the first value to the last while
// the stable step hardly changes. If a body stiffens or is moved, it is reset to the first.
constexpr std::int64_t first_watch = 6;
constexpr std::int64_t last_watch = 48;
constexpr double steady = 0.97;  // hardly changed: this share of the last stable step, or more

// Whether the path moves at any time between `from` and `to`.
bool path_moves(const Path& path, double from, double to) {
  KeyFrame last;
  for (const KeyFrame& key : path.keys) {
    const bool differs =
        key.move != last.move || key.turn != last.turn || key.deform != last.deform;
    if (differs && key.time > from && last.time < to) return true;
    last = key;
  }
  return false;
}

// Whether pins, obstacles or tools move at any time between `from` and `to`.
bool anything_is_moved(const Controls& controls, double from, double to) {
  return any_path(controls, [&](const Path& path) { return path_moves(path, from, to); });
}

class VerletSteps : public Stepper {
 public:
  VerletSteps(const Model& model, const StepperOptions& options)
      : model_(model), stepper_(model, options.precision) {}

  FirstStep begin(const Controls& controls, const State& state, StepMemory& memory) override {
    const NearStep near{memory.stable_step, std::move(memory.stiff_mode)};
    const bool known = near.mode.size() == state.position.size() && near.step < no_limit;
    StableStep stable =
        find_stable_step(model_, controls, state.position, forces(), known ? &near : nullptr);
    memory = {stable.step, std::move(stable.mode), first_watch, first_watch};
    return {stable.step, no_limit,
            "the stiffest spring is " + describe_spring(model_, stable.stiffest)};
  }

  std::optional<double> watch(double h, const Controls& controls, const State& state,
                              StepMemory& memory) override {
    if (memory.steps_to_watch > 0) return std::nullopt;
    return estimate(h, controls, state, memory);
  }

  StepReport step(double h, const Controls& controls, const Interrupt&, State& state,
                  StepMemory& memory) override {
    StepReport report = stepper_.step(h, controls, state);
    --memory.steps_to_watch;
    report.stable_step = with_guard(memory.stable_step);
    return report;
  }

  double stable_step(const StepMemory& memory) const override {
    return std::min(memory.stable_step, with_guard(memory.stable_step));
  }

  ForceEvaluator& forces() override { return stepper_.forces(); }

 private:
  std::optional<double> estimate(double h, const Controls& controls, const State& state,
                                 StepMemory& memory) {
    memory.steps_to_watch = memory.watch_interval;
    if (memory.stiff_mode.empty()) return std::nullopt;
    const double before = memory.stable_step;
    memory.stable_step =
        watch_stable_step(model_, controls, state.position, h, memory.stiff_mode, forces());
    const bool changing =
        memory.stable_step < steady * before ||
        anything_is_moved(controls, state.time, state.time + static_cast<double>(last_watch) * h);
    memory.watch_interval =
        changing ? first_watch : std::min(2 * memory.watch_interval, last_watch);
    memory.steps_to_watch = memory.watch_interval;
    return memory.stable_step;
  }

  // The stable step with the guard of tets close to inversion, which is stiffer than all other
  // terms and acts at once; infinity if the guard does not act.
  double with_guard(double stable) const {
    const double omega2 = stepper_.guard_frequency2();
    if (omega2 == 0.0) return no_limit;
    const double omega = 2.0 / stable;
    return 2.0 / std::sqrt(omega * omega + omega2);
  }

  const Model& model_;
  VerletStepper stepper_;
};

}  // namespace

std::unique_ptr<Stepper> verlet_steps(const Model& model, const StepperOptions& options);
std::unique_ptr<Stepper> verlet_steps(const Model& model, const StepperOptions& options) {
  return std::make_unique<VerletSteps>(model, options);
}

}  // namespace sinew
