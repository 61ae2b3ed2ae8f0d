// Wall time of runs. Never part of a result.
#pragma once

#include <chrono>

namespace sinew {

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point start) {  // [s]
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace sinew
