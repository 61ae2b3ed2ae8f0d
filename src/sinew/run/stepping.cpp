#include "sinew/run/stepping.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sinew/base/error.h"
#include "sinew/forces/volume.h"
#include "sinew/solver/verlet.h"

namespace sinew {
namespace {

// Steps between two looks at the stable step; a look costs about as much as two steps.
constexpr std::int64_t watch_interval = 48;

// What dt = "auto" takes at most with the implicit stepper [s]: stable at any length, but a step
// shows nothing of swings that are faster.
constexpr double longest_implicit = 1.0 / 60.0;

// A number that rounding has left a little above an integer is that integer.
std::int64_t round_up(double x) {
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(x * (1.0 - 1e-12))));
}

// h with three digits, rounded down: what a user can type and is still stable.
double typed_step(double h) {
  const double unit = std::pow(10.0, std::floor(std::log10(h)) - 2.0);
  return std::floor(h / unit) * unit;
}

[[noreturn]] void refuse(const Scene& scene, const Model& model, const StableStep& stable) {
  const double h = *scene.dt / scene.substeps;
  throw Error(
      ErrorKind::unstable,
      fmt::format("the step {:.4g} s is above the largest stable one, {:.4g} s; the stiffest "
                  "spring is {}",
                  h, stable.step, describe_spring(model, stable.stiffest)),
      fmt::format("a smaller step (dt <= {:.3g}, or dt = \"auto\"); or more substeps (substeps = "
                  "{}); or a softer material or a coarser mesh. allow_unstable = true runs it all "
                  "the same",
                  typed_step(stable.step * scene.substeps), round_up(*scene.dt / stable.step)),
      Location{scene.file});
}

// Rest states differ from frame to frame only where pins, loads or obstacles change with time.
bool changes_with_time(const Model& model) {
  for (const Obstacle& o : model.obstacles) {
    if (!o.path.keys.empty()) return true;
  }
  for (const Pin& pin : model.pins) {
    if (!pin.path.keys.empty()) return true;
  }
  for (const Load& load : model.loads) {
    if (load.start > 0.0 || load.ramp > 0.0 || load.end < no_limit) return true;
  }
  return false;
}

}  // namespace

Stepping::Stepping(const Scene& scene, const Model& model, RunState& run)
    : model_(model),
      workspace_(model),
      automatic_(!scene.dt.has_value()),
      allow_unstable_(scene.allow_unstable),
      safety_(scene.safety),
      duration_(scene.duration),
      interval_(1.0 / scene.output.fps),
      tolerance_(scene.tolerance) {
  if (scene.stepper == "static") {
    static_ = std::make_unique<StaticSolver>(model);
    if (!changes_with_time(model)) interval_ = duration_;
    frames_ = round_up(duration_ / interval_);
    return;
  }
  if (scene.stepper == "implicit") {
    implicit_ = std::make_unique<ImplicitStepper>(model);
    implicit_options_.scheme = scene.scheme == "sdirk2" ? Scheme::sdirk2 : Scheme::backward_euler;
    implicit_options_.tolerance = tolerance_;
  }
  if (!automatic_) interval_ = std::max(interval_, *scene.dt / scene.substeps);
  frames_ = round_up(duration_ / interval_);
  if (run.target_step > 0.0) return;  // goes on from a checkpoint
  if (implicit_) {
    run.target_step =
        automatic_ ? std::min(interval_, longest_implicit) : *scene.dt / scene.substeps;
    run.stable_step = run.smallest_stable_step = no_limit;
    return;
  }

  StableStep stable = find_stable_step(model, run.state.position, workspace_);
  run.stable_step = stable.step;
  run.smallest_stable_step = stable.step;
  run.stiff_mode = std::move(stable.mode);
  run.steps_to_watch = watch_interval;
  if (automatic_) {
    run.target_step = std::min(safety_ * stable.step, interval_);
  } else {
    run.target_step = *scene.dt / scene.substeps;
    if (run.target_step > stable.step && !allow_unstable_) refuse(scene, model, stable);
  }
}

double Stepping::frame_end(std::int64_t frame) const {
  return std::min(duration_, static_cast<double>(frame) * interval_);
}

void Stepping::begin_frame(RunState& run) const {
  const double end = frame_end(run.frame + 1);
  if (automatic_) {
    const double span = end - run.state.time;
    run.steps_left = round_up(span / run.target_step);
    run.step = span / static_cast<double>(run.steps_left);
  } else {
    // Frame f ends with the step nearest to its time, counted from the start: nothing adds up.
    run.step = run.target_step;
    run.steps_left = std::max<std::int64_t>(1, std::llround(end / run.step)) - run.state.step;
  }
}

// Takes at most `step` for the rest of the frame.
void Stepping::shorten(RunState& run, double step) const {
  ++run.step_reductions;
  run.target_step = step;
  const double span = run.step * static_cast<double>(run.steps_left);
  run.steps_left = round_up(span / step);
  run.step = span / static_cast<double>(run.steps_left);
}

// The guard of tets about to turn over is stiffer than all the rest and acts at once.
void Stepping::watch_guard(RunState& run) const {
  const double omega2 = guard_frequency2(model_, workspace_);
  if (omega2 == 0.0) return;
  const double omega = 2.0 / run.stable_step;
  const double stable = 2.0 / std::sqrt(omega * omega + omega2);
  run.smallest_stable_step = std::min(run.smallest_stable_step, stable);
  if (run.step > safety_ * stable) shorten(run, safety_ * stable);
}

void Stepping::watch(RunState& run) {
  run.steps_to_watch = watch_interval;
  if (run.stiff_mode.empty()) return;
  run.stable_step =
      watch_stable_step(model_, run.state.position, run.step, run.stiff_mode, workspace_);
  run.smallest_stable_step = std::min(run.smallest_stable_step, run.stable_step);
  const double wish = std::min(safety_ * run.stable_step, interval_);
  if (!automatic_) {
    if (run.step > run.stable_step) ++run.unstable_watches;
  } else if (run.step > 1.03 * wish) {
    // The margin is being eaten up: shorten the rest of the frame.
    shorten(run, wish);
  } else if (wish > 1.25 * run.target_step) {
    run.target_step = wish;  // from the next frame on
  }
}

bool Stepping::rest_frame(RunState& run, const std::atomic<bool>* stop) {
  StaticOptions options;
  options.tolerance = tolerance_;
  options.stop = stop;
  const StaticReport report = static_->solve(frame_end(run.frame + 1), options, run.state);
  run.newton_steps += report.newton;
  run.products += report.products;
  run.residual = report.residual;
  run.contacts = report.contacts;
  run.unmet_limits += report.within ? 0 : 1;
  if (report.stopped) return false;
  ++run.frame;
  return true;
}

bool Stepping::advance_frame(RunState& run, const std::atomic<bool>* stop) {
  if (static_) return rest_frame(run, stop);
  if (run.steps_left == 0) begin_frame(run);
  while (implicit_ && run.steps_left > 0) {
    const ImplicitReport report = implicit_->step(run.step, implicit_options_, run.state);
    --run.steps_left;
    run.newton_steps += report.newton;
    run.products += report.products;
    run.residual = std::max(run.residual, report.residual);
    run.step_reductions += report.cuts;
    run.contacts = report.contacts;
    run.unmet_limits += report.within ? 0 : 1;
    run.righting_steps += report.righted;
    if (run.steps_left > 0 && stop != nullptr && stop->load()) return false;
  }
  while (run.steps_left > 0) {
    if (run.steps_to_watch == 0) watch(run);
    const VerletReport report = verlet_step(model_, run.step, run.state, workspace_);
    --run.steps_left;
    --run.steps_to_watch;
    if (automatic_ && model_.has_volume && run.steps_left > 0) watch_guard(run);
    run.contacts = report.contacts;
    run.limit_sweeps += report.limit_sweeps;
    run.righting_steps += report.righted > 0 ? 1 : 0;
    run.unmet_limits += report.limits_met && report.volume_met ? 0 : 1;
    if (run.steps_left > 0 && stop != nullptr && stop->load()) return false;
  }
  ++run.frame;
  if (automatic_) run.state.time = frame_end(run.frame);
  return true;
}

}  // namespace sinew
