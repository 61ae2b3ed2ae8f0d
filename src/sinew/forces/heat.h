// What dashpots, viscosity and drag turn into heat.
#pragma once

#include <span>

#include "sinew/model/model.h"

namespace sinew {

// a . C(x) b [W], C the matrix of dashpots and viscosity at positions x and of drag: symmetric and
// positive semidefinite. With a = b the heat per time of velocities a; with a the velocities on
// which the damping forces depend and b others, the power of these forces on b, with the opposite
// sign. a and b of all nodes [m/s]; drag counts on free nodes only.
double damping_power(const Model& model, std::span<const Vec3> x, std::span<const Vec3> a,
                     std::span<const Vec3> b);

}  // namespace sinew
