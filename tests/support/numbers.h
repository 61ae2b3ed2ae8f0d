// Values that are not numbers.
#pragma once

#include <limits>

namespace sinew::test {

inline constexpr double inf = std::numeric_limits<double>::infinity();
inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();

}  // namespace sinew::test
