// Repeated measurements of one piece of work.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <vector>

namespace sinew::study {

// Seconds of one execution, over repetitions of a warm program.
struct Timing {
  double median = 0.0;  // [s]
  double min = 0.0;     // [s]
  double spread = 0.0;  // between the quartiles, as a share of the median [-]
  int repetitions = 0;
  int batch = 0;  // executions in a repetition
};

struct TimerOptions {
  double seconds = 0.3;    // minimum duration, after five repetitions
  double shortest = 2e-3;  // minimum of a repetition [s]; it has as many executions as necessary
  int most_in_batch = 1000;
  const std::atomic<bool>* stop = nullptr;
};

// Calls `run` once to warm up, then in at least five repetitions; `prepare`, which is not counted,
// runs before each. Nothing if `stop` was set.
std::optional<Timing> measure(const TimerOptions& options, const std::function<void()>& prepare,
                              const std::function<void()>& run);

// Of the given repetitions, in seconds an execution; at least one.
Timing timing_of(std::vector<double> seconds, int batch);

}  // namespace sinew::study
