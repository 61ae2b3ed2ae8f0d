// Positions and labels of an axis's ticks.
#pragma once

#include <string>
#include <vector>

namespace sinew::report {

struct Ticks {
  std::vector<double> at;           // ascending, within the range
  std::vector<std::string> labels;  // (ticks); UTF-8: "−0.5", "2·10⁻⁵"
};

// Multiples of 1, 2 or 5 times a power of ten, at most about `most` of them. Requires low < high,
// both finite, and a span that exceeds the rounding error of its ends (see Scale in svg_frame.h).
Ticks linear_ticks(double low, double high, int most = 7);

// Powers of ten, thinned to at most about `most`; with 2 and 5 between them if the range is less
// than three decades; linear ticks if even these are too few. Requires 0 < low < high.
Ticks log_ticks(double low, double high, int most = 7);

}  // namespace sinew::report
