#include "sinew/study/bench_timer.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "sinew/solver/deadline.h"

namespace sinew::study {
namespace {

constexpr int fewest = 5;

bool stopped(const TimerOptions& options) {
  return options.stop != nullptr && options.stop->load();
}

}  // namespace

Timing timing_of(std::vector<double> seconds, int batch) {
  std::sort(seconds.begin(), seconds.end());
  // Linear between the two nearest in rank.
  const auto quantile = [&](double q) {
    const double at = q * static_cast<double>(seconds.size() - 1);
    const auto low = static_cast<std::size_t>(at);
    const std::size_t high = std::min(low + 1, seconds.size() - 1);
    return seconds[low] + (at - std::floor(at)) * (seconds[high] - seconds[low]);
  };
  Timing t;
  t.median = quantile(0.5);
  t.min = seconds.front();
  t.spread = t.median > 0.0 ? (quantile(0.75) - quantile(0.25)) / t.median : 0.0;
  t.repetitions = static_cast<int>(seconds.size());
  t.batch = batch;
  return t;
}

std::optional<Timing> measure(const TimerOptions& options, const std::function<void()>& prepare,
                              const std::function<void()>& run) {
  const auto timed = [&](int batch) {
    prepare();
    const Clock::time_point start = Clock::now();
    for (int i = 0; i < batch; ++i) run();
    return seconds_since(start) / batch;
  };
  // Twice as many until a repetition is long enough: the first ones are slow, from cold caches.
  int batch = 1;
  while (!stopped(options)) {
    if (timed(batch) * batch >= options.shortest || 2 * batch > options.most_in_batch) break;
    batch *= 2;
  }
  std::vector<double> seconds;
  const Clock::time_point start = Clock::now();
  while (!stopped(options) &&
         (static_cast<int>(seconds.size()) < fewest || seconds_since(start) < options.seconds)) {
    seconds.push_back(timed(batch));
  }
  if (stopped(options)) return std::nullopt;
  return timing_of(std::move(seconds), batch);
}

}  // namespace sinew::study
