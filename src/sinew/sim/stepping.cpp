#include "sinew/sim/stepping.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sinew/base/error.h"
#include "sinew/forces/packed.h"
#include "sinew/forces/volume.h"
#include "sinew/sim/choose_stepper.h"
#include "sinew/solver/verlet.h"

namespace sinew {
namespace {

// Steps between two looks at the stable step; a look costs about as much as two steps in double
// precision, or as five in single. As long as the body is calm they grow, from the first to the
// last; a body that stiffens or is moved calls for the first again.
constexpr std::int64_t first_watch = 6;
constexpr std::int64_t last_watch = 48;
constexpr double calm = 0.97;  // of the stable step is left since the last look, or more

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

// What only Verlet's step does; null where the scene has no such thing.
const char* only_verlet_knows(const Model& model) {
  return model.bounces() ? "restitution" : nullptr;
}

// Whether the path goes on anywhere between the times `from` and `to`.
bool moves(const Path& path, double from, double to) {
  KeyFrame last;
  for (const KeyFrame& key : path.keys) {
    const bool differs =
        key.move != last.move || key.turn != last.turn || key.deform != last.deform;
    if (differs && key.time > from && last.time < to) return true;
    last = key;
  }
  return false;
}

bool is_moved(const Model& model, double from, double to) {
  const auto goes_on = [&](const auto& thing) { return moves(thing.path, from, to); };
  return std::any_of(model.pins.begin(), model.pins.end(), goes_on) ||
         std::any_of(model.obstacles.begin(), model.obstacles.end(), goes_on);
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

Stepping::Stepping(const Scene& scene, const Model& model, const Controls& controls, RunState& run)
    : model_(model),
      workspace_(model),
      automatic_(!scene.dt.has_value()),
      given_(automatic_ ? 0.0 : *scene.dt / scene.substeps),
      allow_unstable_(scene.allow_unstable),
      safety_(scene.safety),
      duration_(scene.duration),
      interval_(1.0 / scene.output.fps),
      tolerance_(scene.tolerance) {
  if (run.stepper.empty() && scene.stepper != "auto") run.stepper = scene.stepper;
  if (run.stepper == "static") {
    static_ = std::make_unique<StaticSolver>(model);
    if (!changes_with_time(model)) interval_ = duration_;
    frames_ = round_up(duration_ / interval_);
    return;
  }
  if (scene.budget_ms) budget_ = 1e-3 * *scene.budget_ms;
  if (!automatic_) interval_ = std::max(interval_, given_);
  frames_ = round_up(duration_ / interval_);
  const bool goes_on = run.target_step > 0.0;  // from a checkpoint

  const double implicit_step = !automatic_ ? given_
                               : budget_   ? interval_
                                           : std::min(interval_, longest_implicit);
  if (run.stepper != "verlet") {
    implicit_ = std::make_unique<ImplicitStepper>(model);
    implicit_options_.scheme = scene.scheme == "sdirk2" ? Scheme::sdirk2 : Scheme::backward_euler;
    implicit_options_.tolerance = tolerance_;
    implicit_options_.single = scene.precision == "single";
  }
  if (scene.precision == "single" && run.stepper != "implicit") {
    workspace_.packed = std::make_shared<PackedForces>(model);
  }
  StableStep stable;
  if (!goes_on && run.stepper != "implicit") {
    stable = find_stable_step(model, controls, run.state.position, workspace_);
  }
  if (run.stepper.empty()) choose(scene, controls, stable, implicit_step, run);
  if (run.stepper == "implicit") {
    workspace_.packed.reset();
    if (budget_) implicit_->prepare(implicit_step, controls, implicit_options_);
    if (goes_on) return;
    run.target_step = implicit_step;
    run.stable_step = run.smallest_stable_step = no_limit;
    return;
  }
  if (goes_on) return;
  run.stable_step = stable.step;
  run.smallest_stable_step = stable.step;
  run.stiff_mode = std::move(stable.mode);
  run.steps_to_watch = run.watch_interval = first_watch;
  run.target_step = verlet_step_at(stable.step);
  if (!automatic_ && run.target_step > stable.step && !allow_unstable_) {
    refuse(scene, model, stable);
  }
}

// stepper = "auto"
void Stepping::choose(const Scene& scene, const Controls& controls, const StableStep& stable,
                      double implicit_step, RunState& run) {
  const Contest contest{interval_, verlet_step_at(stable.step), stable.step, implicit_step,
                        only_verlet_knows(model_)};
  Choice choice =
      choose_stepper(scene, model_, controls, run.state, contest, implicit_options_, *implicit_);
  run.stepper = std::move(choice.stepper);
  run.stepper_reason = std::move(choice.reason);
  if (run.stepper == "verlet") implicit_.reset();
}

// What Verlet's step is at the start, where the stable one is `stable`.
double Stepping::verlet_step_at(double stable) const {
  return automatic_ ? std::min(safety_ * stable, interval_) : given_;
}

double Stepping::frame_end(std::int64_t frame) const {
  return std::min(duration_, static_cast<double>(frame) * interval_);
}

void Stepping::begin_frame(RunState& run) const {
  run.work = {};
  const double end = frame_end(run.frame + 1);
  double span = end - run.state.time;
  if (!automatic_) {
    // A frame ends with the given step nearest to its time, counted from the start: nothing adds
    // up.
    run.steps_left = std::max<std::int64_t>(1, std::llround(end / given_)) -
                     std::llround(run.state.time / given_);
    run.step = given_;
    span = given_ * static_cast<double>(run.steps_left);
    if (run.target_step >= given_ || run.steps_left == 0) return;
  }
  run.steps_left = round_up(span / run.target_step);
  run.step = span / static_cast<double>(run.steps_left);
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
  if (too_long(run, stable, 1.0)) shorten(run, safety_ * stable);
}

// A step that Sinew chose keeps its margin to the stable one; a given one may use all of it.
bool Stepping::too_long(const RunState& run, double stable, double slack) const {
  if (automatic_ || run.target_step < given_) return run.step > slack * safety_ * stable;
  return run.step > stable && !allow_unstable_;
}

void Stepping::watch(const Controls& controls, RunState& run) {
  run.steps_to_watch = run.watch_interval;
  if (run.stiff_mode.empty()) return;
  const double before = run.stable_step;
  run.stable_step =
      watch_stable_step(model_, controls, run.state.position, run.step, run.stiff_mode, workspace_);
  run.smallest_stable_step = std::min(run.smallest_stable_step, run.stable_step);
  const double time = run.state.time;
  const bool stirred = run.stable_step < calm * before ||
                       is_moved(model_, time, time + static_cast<double>(last_watch) * run.step);
  run.watch_interval = stirred ? first_watch : std::min(2 * run.watch_interval, last_watch);
  run.steps_to_watch = run.watch_interval;
  const double longest = automatic_ ? interval_ : given_;
  const double wish = std::min(safety_ * run.stable_step, longest);
  if (too_long(run, run.stable_step, 1.03)) {
    // The margin is being eaten up: shorten the rest of the frame.
    shorten(run, wish);
  } else if (wish > 1.25 * run.target_step || (wish == longest && wish > run.target_step)) {
    run.target_step = wish;  // from the next frame on
    ++run.step_increases;
  }
}

bool Stepping::rest_frame(const Controls& controls, RunState& run, const std::atomic<bool>* stop) {
  StaticOptions options;
  options.tolerance = tolerance_;
  options.stop = stop;
  const Clock::time_point start = Clock::now();
  const StaticReport report =
      static_->solve(controls, frame_end(run.frame + 1), options, run.state);
  run.newton_steps += report.newton;
  run.products += report.products;
  run.residual = report.residual;
  run.work = {seconds_since(start), 1, report.newton, report.products, report.residual, 0};
  run.contacts = report.contacts;
  run.unmet_limits += report.within ? 0 : 1;
  if (report.stopped) return false;
  ++run.frame;
  return true;
}

void Stepping::implicit_steps(const Controls& controls, RunState& run,
                              const std::atomic<bool>* stop) {
  while (run.steps_left > 0) {
    const Clock::time_point start = Clock::now();
    ImplicitOptions options = implicit_options_;
    if (budget_) {  // an equal share of what is left
      const std::chrono::duration<double> share((*budget_ - run.work.seconds) /
                                                static_cast<double>(run.steps_left));
      options.deadline = start + std::chrono::duration_cast<Clock::duration>(share);
    }
    const ImplicitReport report = implicit_->step(run.step, controls, options, run.state);
    --run.steps_left;
    run.newton_steps += report.newton;
    run.products += report.products;
    run.residual = std::max(run.residual, report.residual);
    run.step_cuts += report.cuts;
    run.contacts = report.contacts;
    run.depth = report.deepest;
    run.deepest = std::max(run.deepest, report.deepest);
    run.friction_work += report.friction;
    run.unmet_limits += report.within ? 0 : 1;
    run.righting_steps += report.righted;
    ++run.work.steps;
    run.work.newton_steps += report.newton;
    run.work.products += report.products;
    run.work.residual = std::max(run.work.residual, report.residual);
    run.work.cut_short += report.ran_out ? 1 : 0;
    run.work.seconds += seconds_since(start);
    if (stop != nullptr && stop->load()) return;
  }
}

void Stepping::verlet_steps(const Controls& controls, RunState& run,
                            const std::atomic<bool>* stop) {
  const Clock::time_point start = Clock::now();
  const double before = run.work.seconds;
  while (run.steps_left > 0) {
    if (run.steps_to_watch == 0) watch(controls, run);
    const VerletReport report = verlet_step(model_, controls, run.step, run.state, workspace_);
    --run.steps_left;
    --run.steps_to_watch;
    if (model_.has_volume && run.steps_left > 0) watch_guard(run);
    run.contacts = report.contact.contacts;
    run.depth = report.contact.deepest;
    run.deepest = std::max(run.deepest, report.contact.deepest);
    run.friction_work += report.contact.friction;
    run.limit_sweeps += report.limit_sweeps;
    run.righting_steps += report.righted > 0 ? 1 : 0;
    run.unmet_limits += report.limits_met && report.volume_met ? 0 : 1;
    ++run.work.steps;
    run.work.seconds = before + seconds_since(start);
    if (stop != nullptr && stop->load()) return;
  }
}

bool Stepping::advance_frame(const Controls& controls, RunState& run,
                             const std::atomic<bool>* stop) {
  if (static_) return rest_frame(controls, run, stop);
  if (run.steps_left == 0) begin_frame(run);
  if (implicit_) {
    implicit_steps(controls, run, stop);
  } else {
    verlet_steps(controls, run, stop);
  }
  if (run.steps_left > 0) return false;
  ++run.frame;
  if (automatic_) run.state.time = frame_end(run.frame);
  if (budget_) run.frame_seconds.push_back(run.work.seconds);
  run.frames_cut_short += run.work.cut_short > 0 ? 1 : 0;
  return true;
}

}  // namespace sinew
