// The wall-clock time at which a step has to end, in budget mode:
// docs/methods/budget.md.
#pragma once

#include <optional>

#include "sinew/base/clock.h"

namespace sinew {

using Deadline = std::optional<Clock::time_point>;  // none: all the time it takes

inline bool passed(const Deadline& deadline) {
  return deadline && Clock::now() >= *deadline;
}

}  // namespace sinew
