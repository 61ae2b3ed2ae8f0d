#include "sinew/sim/stepping.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sinew/base/clock.h"
#include "sinew/base/error.h"
#include "sinew/scene/keys.h"
#include "sinew/sim/choose_stepper.h"
#include "sinew/solver/stable_step.h"

namespace sinew {
namespace {

// Largest difference between a requested time and the end of a frame that counts as equal, as a
// share of a frame.
constexpr double same_time = 1e-9;

// The stable step is an estimate: a step up to this factor above its share is not shortened.
constexpr double estimate_slack = 1.03;

// h rounded down to three digits, so that a user can type it and it is still stable.
double typed_step(double h) {
  const double unit = std::pow(10.0, std::floor(std::log10(h)) - 2.0);
  return std::floor(h / unit) * unit;
}

[[noreturn]] void refuse(const SteppingOptions& options, const FirstStep& first) {
  const double substeps = *options.dt / first.stable;
  throw Error(
      ErrorKind::unstable,
      fmt::format("the step {:.4g} s is above the largest stable one, {:.4g} s; {}",
                  options.given(), first.stable, first.limited_by),
      fmt::format("a smaller step (dt <= {:.3g}, or dt = \"auto\"); {}or a softer material or a "
                  "coarser mesh. allow_unstable = true runs it all the same",
                  typed_step(first.stable * options.substeps),
                  substeps < most_substeps ? fmt::format("or more substeps (substeps = {}); ",
                                                         count_parts(*options.dt, first.stable))
                                           : std::string()),
      Location{options.file});
}

// Throws for a given step that does not fit into the run, or is so short that its steps cannot be
// counted.
void check_given(const SteppingOptions& options) {
  const double given = options.given();
  if (!(given <= options.duration * (1.0 + 1e-9)))
    throw Error(ErrorKind::input,
                fmt::format("the step {:g} s is longer than the whole run, {:g} s", given,
                            options.duration),
                "a smaller dt, or a longer duration", Location{options.file});
  count_parts(options.duration < no_limit ? options.duration : options.interval, given);
}

// Throws if the step has left an account or a node that is not a number.
void require_finite(const RunState& run) {
  const State& s = run.state;
  const bool account = std::isfinite(s.energy.dissipated) && std::isfinite(s.energy.work_in) &&
                       std::isfinite(run.friction_work);
  // The explicit step checks its nodes itself, by name.
  const bool nodes = run.stepper == StepperKind::verlet ||
                     (std::all_of(s.position.begin(), s.position.end(),
                                  [](const Vec3& x) { return x.allFinite(); }) &&
                      std::all_of(s.half_velocity.begin(), s.half_velocity.end(),
                                  [](const Vec3& v) { return v.allFinite(); }));
  if (account && nodes) return;
  throw Error(
      ErrorKind::diverged,
      fmt::format(
          "{} at {:.6g} s, in step {}",
          nodes ? "the energy account is no longer finite" : "the positions are no longer finite",
          s.time, s.step),
      "look for forces, speeds, stiffnesses or a dt out of all proportion: they are in SI units");
}

// Rest states differ from frame to frame only where pins, loads, obstacles or tools change with
// time.
bool changes_with_time(const Model& model, const Controls& controls) {
  if (any_path(controls, [](const Path& path) { return !path.keys.empty(); })) return true;
  for (const Load& load : model.loads) {
    if (load.start > 0.0 || load.ramp > 0.0 || load.end < no_limit) return true;
  }
  return false;
}

}  // namespace

Stepping::Stepping(const SteppingOptions& options, const Model& model, const Controls& controls,
                   RunState& run)
    : model_(model), options_(options) {
  share_ = options_.allow_unstable ? 1.0 : accurate_share(model);
  options_.safety = std::min(options_.safety, share_);
  const bool goes_on = run.target_step > 0.0;  // a resumed run
  const StepperKind kind = goes_on ? run.stepper : options.stepper;
  const bool rest = kind == StepperKind::rest && options.pace == Pace::any;
  if (rest) options_.dt.reset();  // rest states have no step length
  if (options_.dt) {
    check_given(options_);
    options_.interval = std::max(options_.interval, options_.given());
  }
  frame_interval_ = options_.interval;
  if (rest && !options_.cuts_later && !changes_with_time(model, controls) &&
      options_.duration < no_limit) {
    options_.interval = options_.duration;
  }
  frames_ = count_frames(options_.duration, options_.interval);
  if (goes_on) {
    stepper_ = make_stepper(run.stepper, model, options_.method);
  } else {
    begin_run(controls, run);
  }
  if (options_.budget) stepper_->prepare(run.target_step, controls);
}

void Stepping::begin_run(const Controls& controls, RunState& run) {
  StepperChoice choice = choose_stepper(options_, model_, controls, run.state);
  stepper_ = std::move(choice.stepper);
  run.stepper = choice.kind;
  run.stepper_reason = std::move(choice.reason);
  run.memory = std::move(choice.memory);
  run.smallest_stable_step = choice.first.stable;
  run.target_step = options_.first_length(choice.first);
  limited_by_ = choice.first.limited_by;
  if (!automatic() && run.target_step > choice.first.stable && !options_.allow_unstable) {
    refuse(options_, choice.first);
  }
  if (!automatic() && !options_.allow_unstable)
    run.target_step = std::min(run.target_step, share_ * choice.first.stable);
  if (options_.duration < no_limit) count_parts(options_.duration, run.target_step);
}

std::string Stepping::division(const RunState& run) const {
  const double stable = run.smallest_stable_step;
  if (automatic() || share_ == 1.0 || !(options_.given() > share_ * stable)) return {};
  return fmt::format(
      "the given step {:.4g} s is above {:.2g} of the stable one ({:.4g} s), up to which explicit "
      "steps keep the energy of undamped bodies and of impacts with restitution; it is divided. "
      "Take dt <= {:.3g}, or dt = \"auto\"",
      options_.given(), share_, stable, typed_step(share_ * stable * options_.substeps));
}

double Stepping::frame_end(std::int64_t frame) const {
  return std::min(options_.duration, static_cast<double>(frame) * options_.interval);
}

void Stepping::begin_frame(RunState& run) const {
  const double end = frame_end(run.frame + 1);
  // A frame ends with the given step nearest to its time, counted from the start, so that rounding
  // does not accumulate.
  plan(run, end, automatic() ? 0 : std::max<std::int64_t>(1, std::llround(end / options_.given())));
}

void Stepping::finish_frame(RunState& run) const {
  ++run.frame;
  if (automatic()) run.state.time = frame_end(run.frame);
  if (options_.budget) run.frame_seconds.push_back(run.work.seconds);
  run.frames_cut_short += run.work.steps_cut_short > 0 ? 1 : 0;
}

// Plans steps to `end`: with a given dt those up to number `given_steps` from the start, otherwise
// of equal length.
void Stepping::plan(RunState& run, double end, std::int64_t given_steps) const {
  run.work = {};
  double span = end - run.state.time;
  if (!automatic()) {
    const double given = options_.given();
    run.steps_left = given_steps - std::llround(run.state.time / given);
    run.step = given;
    span = given * static_cast<double>(run.steps_left);
    if (run.target_step >= given || run.steps_left == 0) return;
  }
  run.steps_left = count_parts(span, run.target_step);
  run.step = span / static_cast<double>(run.steps_left);
}

// Shortens the steps of the rest of the frame to at most `step`.
void Stepping::shorten(RunState& run, double step) const {
  ++run.step_reductions;
  run.target_step = step;
  const double span = run.step * static_cast<double>(run.steps_left);
  run.steps_left = count_parts(span, step);
  run.step = span / static_cast<double>(run.steps_left);
}

// A step chosen by Sinew keeps its margin to the stable step; a given step may use all of it.
bool Stepping::too_long(const RunState& run, double stable, double slack) const {
  if (automatic() || run.target_step < options_.given()) {
    return run.step > slack * options_.safety * stable;
  }
  return run.step > share_ * stable && !options_.allow_unstable;
}

// Adapts the length of the steps to the stable step if it was estimated again.
void Stepping::watch(const Controls& controls, RunState& run) {
  const auto stable = stepper_->watch(run.step, controls, run.state, run.memory);
  if (stable) adapt(*stable, run);
}

void Stepping::choose_step_again(const Controls& controls, RunState& run) {
  const double stable = stepper_->begin(controls, run.state, run.memory).stable;
  if (stable == no_limit) return;
  if (run.steps_left > 0) return adapt(stable, run);
  run.smallest_stable_step = std::min(run.smallest_stable_step, stable);
  if (!options_.allow_unstable)
    run.target_step = std::min(run.target_step, options_.safety * stable);
}

void Stepping::adapt(double stable, RunState& run) {
  run.smallest_stable_step = std::min(run.smallest_stable_step, stable);
  const double longest = automatic() ? options_.interval : options_.given();
  const double wish = std::min(options_.safety * stable, longest);
  if (too_long(run, stable, estimate_slack)) {
    // The margin is used up: shorten the rest of the frame.
    shorten(run, wish);
  } else if (wish > 1.25 * run.target_step || (wish == longest && wish > run.target_step)) {
    run.target_step = wish;  // from the next frame on
    ++run.step_increases;
  }
}

// Returns false if `stop` was set before the step was done.
bool Stepping::one_step(const Controls& controls, RunState& run, const std::atomic<bool>* stop) {
  const Clock::time_point start = Clock::now();
  watch(controls, run);
  Interrupt interrupt{{}, stop, options_.cancel};
  if (options_.budget) {  // an equal share of the remaining time
    const std::chrono::duration<double> share((*options_.budget - run.work.seconds) /
                                              static_cast<double>(run.steps_left));
    interrupt.deadline = start + std::chrono::duration_cast<Clock::duration>(share);
  }
  const StepReport report = stepper_->step(run.step, controls, interrupt, run.state, run.memory);
  run.add(report);
  require_finite(run);
  run.work.add(report);
  ++run.work.steps;
  run.work.seconds += seconds_since(start);
  if (report.stopped) {
    run.steps_left = 0;  // the rest of the frame is planned again when the run continues
    return false;
  }
  --run.steps_left;
  if (run.steps_left > 0 && report.stable_step < no_limit) {
    run.smallest_stable_step = std::min(run.smallest_stable_step, report.stable_step);
    if (too_long(run, report.stable_step, 1.0)) shorten(run, options_.safety * report.stable_step);
  }
  return true;
}

// Takes the planned steps. Returns false if `stop` was set before they were done.
bool Stepping::steps(const Controls& controls, RunState& run, const std::atomic<bool>* stop) {
  while (run.steps_left > 0) {
    if (!one_step(controls, run, stop)) return false;
    if (run.steps_left > 0 && stop != nullptr && stop->load()) return false;
  }
  return true;
}

bool Stepping::step(const Controls& controls, RunState& run, const std::atomic<bool>* stop) {
  if (run.steps_left == 0) begin_frame(run);
  if (run.steps_left > 0 && !one_step(controls, run, stop)) return false;
  if (run.steps_left > 0) return false;
  finish_frame(run);
  return true;
}

bool Stepping::advance_frame(const Controls& controls, RunState& run,
                             const std::atomic<bool>* stop) {
  if (run.steps_left == 0) begin_frame(run);
  if (!steps(controls, run, stop)) return false;
  finish_frame(run);
  return true;
}

Stepping::Progress Stepping::advance_to(const Controls& controls, RunState& run, double end,
                                        const std::atomic<bool>* stop) {
  const double slack = same_time * frame_interval_;
  if (frame_end(run.frame + 1) <= end + slack) {
    return advance_frame(controls, run, stop) ? Progress::frame : Progress::stopped;
  }
  if (end - run.state.time <= slack) return Progress::arrived;
  plan(run, end, automatic() ? 0 : std::llround(end / options_.given()));
  if (run.steps_left <= 0) {
    run.steps_left = 0;
    return Progress::arrived;
  }
  const bool done = steps(controls, run, stop);
  run.steps_left = 0;  // the next frame or part of one is planned from the current time
  if (!done) return Progress::stopped;
  if (automatic()) run.state.time = end;
  return Progress::arrived;
}

void Stepping::take_step(const Controls& controls, RunState& run, double h) {
  run.work = {};
  run.step = h;
  run.steps_left = 1;
  steps(controls, run, nullptr);
  resume_at(run);
}

void Stepping::require_stable(const Controls& controls, RunState& run, double h) {
  if (options_.allow_unstable) return;
  watch(controls, run);
  const double longest = longest_step(run);
  if (h <= longest) return;
  throw Error(
      ErrorKind::unstable,
      fmt::format("the step {:.4g} s is above the largest stable one, {:.4g} s", h, longest),
      "use a smaller step, or advance(), which chooses a stable one; or a softer material, a "
      "coarser mesh or stepper = \"implicit\"");
}

double Stepping::prepare(const Controls& controls, RunState& run) {
  while (run.steps_left == 0) {
    begin_frame(run);
    if (run.steps_left == 0) finish_frame(run);
  }
  watch(controls, run);
  return run.step;
}

void Stepping::resume_at(RunState& run) const {
  run.steps_left = 0;
  run.frame = static_cast<std::int64_t>(std::floor(run.state.time / options_.interval + same_time));
}

}  // namespace sinew
