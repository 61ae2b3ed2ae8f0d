// Repeated measurements of one piece of work.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <vector>

namespace sinew::study {

// Seconds that one execution takes, over repetitions of a warm program.
struct Timing {
  double median = 0.0;  // [s]
  double min = 0.0;     // [s]
  double spread = 0.0;  // between the quartiles, as a share of the median [-]
  int repetitions = 0;
  int batch = 0;  // executions a repetition holds
};

struct TimerOptions {
  double seconds = 0.3;    // to go on for, once there are five repetitions
  double shortest = 2e-3;  // of a repetition [s]: it holds as many executions as that takes
  int most_in_batch = 1000;
  const std::atomic<bool>* stop = nullptr;
};

// Calls `run` once to warm up, then in repetitions, at least five of them; `prepare`, which is not
// counted, before each. Nothing where `stop` was set.
std::optional<Timing> measure(const TimerOptions& options, const std::function<void()>& prepare,
                              const std::function<void()>& run);

// Of the given repetitions, in seconds an execution; at least one.
Timing timing_of(std::vector<double> seconds, int batch);

}  // namespace sinew::study
