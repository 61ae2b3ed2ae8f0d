// Limits on the length of springs, projected after the step. Duan et al. 2016.
//   C_stretch  = (1 + tau_s) l0 - |p_i - p_j| >= 0
//   C_compress = |p_i - p_j| - (1 - tau_c) l0 >= 0
#pragma once

#include <vector>

#include "sinew/model/model.h"

namespace sinew {

// The result of a sweep, in springs.
struct LimitSweep {
  Index moved = 0;
  Index over = 0;  // that violated their limit by more than model.limit_tolerance
};

// One Gauss-Seidel sweep over the limited springs, colour by colour. A spring that violates its
// limit by more than model.limit_tolerance (a share of l0) is moved exactly onto it. Its ends are
// weighted by inverse mass, so momentum is conserved. A spring with stretch limit 0 (a distance
// constraint) is moved for any violation; otherwise it would jump from one side of the tolerance to
// the other.
LimitSweep sweep_limits(const Model& model, std::vector<Vec3>& x);

// The largest violation, as a share of l0; 0 if every limit holds.
double measure_limit_violation(const Model& model, const std::vector<Vec3>& x);

}  // namespace sinew
