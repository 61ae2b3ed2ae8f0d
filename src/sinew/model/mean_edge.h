// The length to which tolerances of positions are relative.
#pragma once

#include <cmath>
#include <numbers>

#include "sinew/model/model.h"

namespace sinew {

// Edge length of the regular tet of volume V [m3]: l = (6 sqrt(2) V)^(1/3) [m].
inline double regular_tet_edge(double volume) {
  return std::cbrt(6.0 * std::numbers::sqrt2 * volume);
}

// Edge of the regular tet of the mean volume [m]; without tets the mean length of the springs.
double mean_edge(const Model& model);

}  // namespace sinew
