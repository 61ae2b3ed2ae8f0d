// When work that costs wall time has to stop: of budget mode, docs/methods/budget.md.
#pragma once

#include <chrono>
#include <optional>

namespace sinew {

using Clock = std::chrono::steady_clock;
using Deadline = std::optional<Clock::time_point>;  // none: all the time it takes

inline bool passed(const Deadline& deadline) {
  return deadline && Clock::now() >= *deadline;
}

}  // namespace sinew
