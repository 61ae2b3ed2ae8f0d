// Limits on the length of springs, projected after the step. Duan et al. 2016.
//   C_stretch  = (1 + tau_s) l0 - |p_i - p_j| >= 0
//   C_compress = |p_i - p_j| - (1 - tau_c) l0 >= 0
#pragma once

#include <vector>

#include "sinew/model/model.h"

namespace sinew {

// What a sweep did, in springs.
struct LimitSweep {
  Index moved = 0;
  Index over = 0;  // that violated their limit by more than model.limit_tolerance
};

// One sweep of Gauss-Seidel over the limited springs, colour by colour: a spring that violates its
// limit by more than model.limit_tolerance (a share of l0) is moved exactly onto it, its ends
// weighted by inverse mass, so that momentum is kept. One that may not get longer at all (a
// distance) is moved however little it violates its limit: it would jerk from one side of the
// tolerance to the other otherwise.
LimitSweep sweep_limits(const Model& model, std::vector<Vec3>& x);

// The largest violation, as a share of l0; 0 where every limit holds.
double measure_limit_violation(const Model& model, const std::vector<Vec3>& x);

}  // namespace sinew
