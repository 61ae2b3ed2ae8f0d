// Rotations that need a decomposition. They are compiled once, because Eigen's templates for them
// take seconds in every file that uses one.
#pragma once

#include "sinew/base/vec.h"

namespace sinew {

// The shortest rotation that turns the direction of `from` into that of `to` (both not 0). Of
// opposite directions: half a turn about an axis perpendicular to them.
Eigen::Quaterniond rotation_between(const Vec3& from, const Vec3& to);

// The rotation R that is nearest to m: it maximises tr(R^T m). Of a mirrored m, the direction with
// the smallest singular value is turned back (Kabsch 1976, doi 10.1107/S0567739476001873).
Mat3 nearest_rotation(const Mat3& m);

}  // namespace sinew
