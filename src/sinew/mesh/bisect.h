// Divides a set of points into compact parts of about equal size.
#pragma once

#include <span>
#include <vector>

#include "sinew/base/vec.h"

namespace sinew {

// Divides the points (ids into x) across their longest side at the median, and each half again,
// until no part has more than `most` points. Reorders `points` so that every part is contiguous.
// Recursive coordinate bisection (Berger, Bokhari 1987). An empty set has no parts.
std::vector<std::span<Index>> bisect(std::span<const Vec3> x, std::span<Index> points, Index most);

}  // namespace sinew
