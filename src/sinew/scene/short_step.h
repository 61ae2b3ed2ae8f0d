// A bad tet that makes the explicit steps of a body much shorter than its other tets do.
#pragma once

#include <optional>
#include <string>

namespace sinew {

struct PlacedBody;

struct ShortStep {
  double wave_time = 0.0;  // of pressure waves through the tet [s]
  std::string reason;      // names it, and the remedy
};

// The body's worst tet, if it is near-flat (mesh/doctor.h) and the waves through it need much less
// time than those through the median tet: its name with radius ratio and place, about what the
// steps would be without it, the remedy. Nothing for a body with the uniform law.
std::optional<ShortStep> find_short_step(const PlacedBody& placed);

}  // namespace sinew
