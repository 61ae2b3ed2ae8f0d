// The contact of a tool with tissue between two exchanges with the simulation. docs/haptics.md.
#pragma once

#include <limits>

#include "sinew/base/vec.h"

namespace sinew {

// A plane that gives way like the tissue. At the tool's position `at` the tissue pushes with
// `force`; near it, the force grows by `stiffness` for each metre the tool goes in:
//   f_n(x) = max(0, n . force - k (n . (x - at) + gap)),   f_t(x) = force_t - k (x - at)_t,
// with |f_t| <= mu f_n. Without contact force = 0, and gap is the distance to the tissue.
struct LocalContact {
  Vec3 at = Vec3::Zero();                                // of the tool [m]
  Vec3 force = Vec3::Zero();                             // on the tool there [N]
  Vec3 torque = Vec3::Zero();                            // about `at` [N m]
  Vec3 normal = Vec3::UnitZ();                           // unit, from the tissue to the tool
  double gap = std::numeric_limits<double>::infinity();  // [m] >= 0
  double stiffness = 0.0;                                // [N/m]
};

struct ToolForce {
  Vec3 at = Vec3::Zero();     // of the tool [m]
  Vec3 force = Vec3::Zero();  // on it [N]
};

// Where a tool is that a spring of `coupling` [N/m] pulls to `hand` [m]: the equilibrium of the
// spring and the plane.
ToolForce balance(const LocalContact& contact, const Vec3& hand, double coupling, double friction);

}  // namespace sinew
