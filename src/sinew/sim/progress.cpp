// The progress of a World in time, and its events.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "sinew/base/error.h"
#include "sinew/forces/springs.h"
#include "sinew/io/file_io.h"
#include "sinew/sim/readings.h"
#include "sinew/sim/world.h"

namespace sinew::sim {
namespace {

constexpr double between_looks = 1.0 / 60.0;  // least time between states kept for a return [s]
constexpr std::size_t most_events = 1000;

}  // namespace

template <typename F>
void World::guarded(const F& steps) {
  const std::int64_t reductions = run_.step_reductions;
  ++changes_;
  try {
    arena_.run(steps);
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::diverged) {
      run_ = good_;
      clock_ = run_.state.time;
      note(EventKind::diverged, 1, error.message());
    }
    throw;
  }
  if (run_.step_reductions > reductions)
    note(EventKind::step_shortened, run_.step_reductions - reductions,
         fmt::format("the stable step is {:.4g} s", run_.memory.stable_step));
}

bool World::step() {
  const Busy busy(*this);
  bool finished = false;
  guarded([&] {
    start_moves(stepping_->prepare(*controls_, run_));
    finished = stepping_->step(*controls_, run_);
    if (finished) end_frame();
  });
  clock_ = run_.state.time;
  return finished;
}

void World::step(double dt) {
  const Busy busy(*this);
  guarded([&] {
    stepping_->require_stable(*controls_, run_, dt);
    start_moves(dt);
    stepping_->take_step(*controls_, run_, dt);
    end_frame();
  });
  clock_ = run_.state.time;
}

bool World::advance(double seconds) {
  const Busy busy(*this);
  const double end = clock_ + seconds;
  bool stopped = false;
  guarded([&] {
    start_moves(end - run_.state.time);
    while (true) {
      const Stepping::Progress progress = stepping_->advance_to(*controls_, run_, end, &stop_);
      if (progress == Stepping::Progress::frame) end_frame();
      if (progress == Stepping::Progress::arrived) return;
      stopped = stop_.exchange(false);
      if (stopped) return;
    }
  });
  const bool there = std::abs(end - run_.state.time) <= 1e-9 * stepping_->frame_interval();
  clock_ = stopped || there ? run_.state.time : end;
  return !stopped;
}

bool World::advance_frame(const std::atomic<bool>* stop, Clock::time_point deadline) {
  const Busy busy(*this);
  bool finished = false;
  guarded([&] {
    bool goes_on = true;
    while (goes_on) {
      finished = stepping_->step(*controls_, run_, stop);
      goes_on = !finished && !stepping_->cancelled() && (stop == nullptr || !stop->load()) &&
                Clock::now() < deadline;
    }
    if (finished) {
      cut_on_schedule();
      tear_where_due();
    }
  });
  clock_ = run_.state.time;
  return finished;
}

void World::keep() {
  good_ = run_;
}

void World::log_frame() {
  const StretchRange range = measure_stretch(*model_, run_.state.position);
  run_.peak_stretch = std::max(run_.peak_stretch, range.stretch);
  run_.peak_compress = std::max(run_.peak_compress, range.compress);
  run_.peak_inverted_tets =
      std::max(run_.peak_inverted_tets, count_inverted(*model_, run_.state.position));
  run_.frame_times.push_back(run_.state.time);
}

// Called at the end of a frame, and after a step of a length that the host chose.
void World::end_frame() {
  cut_on_schedule();
  tear_where_due();
  if (run_.state.time - good_.state.time < between_looks * (1.0 - 1e-9)) return;
  keep();
  look_for_inverted_tets();
}

// Adds an event when tets invert and none was inverted at the last check.
void World::look_for_inverted_tets() {
  const std::int64_t count = count_inverted(*model_, run_.state.position);
  if (count > 0 && last_inverted_ == 0)
    note(EventKind::inverted, count, fmt::format("{} tets are inverted", count));
  last_inverted_ = count;
}

// ---- events ----

void World::note(EventKind kind, std::int64_t count, std::string text) {
  if (events_.size() == most_events) events_.pop_front();
  events_.push_back({kind, run_.state.time, count, std::move(text)});
}

void World::note_stepper(StepperKind before) {
  if (run_.stepper == before || run_.stepper_reason.empty()) return;
  note(EventKind::stepper_changed, 1,
       fmt::format("{}: {}", word_of(run_.stepper), run_.stepper_reason));
}

std::vector<Event> World::take_events() {
  const Busy busy(*this);
  std::vector<Event> out(std::make_move_iterator(events_.begin()),
                         std::make_move_iterator(events_.end()));
  events_.clear();
  return out;
}

}  // namespace sinew::sim
