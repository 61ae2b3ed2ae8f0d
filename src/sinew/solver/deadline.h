// The wall-clock time at which a step must end, in budget mode: docs/methods/budget.md.
#pragma once

#include <optional>

#include "sinew/base/clock.h"

namespace sinew {

using Deadline = std::optional<Clock::time_point>;  // none: no time limit

inline bool passed(const Deadline& deadline) {
  return deadline && Clock::now() >= *deadline;
}

}  // namespace sinew
