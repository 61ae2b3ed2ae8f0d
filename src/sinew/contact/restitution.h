// Newton's law of impact in an explicit step, as a pure function on plain values.
// docs/methods/ground.md.
#pragma once

#include <algorithm>

namespace sinew {

// The velocity along the normal with which a contact that closes leaves a step by its bounce [m/s],
// at least 0: -e times the half-step velocity before the step. In the energy of Verlet's method,
// m/2 w- . w+ at the time of the positions, the impulse then does the work
//   impulse (w- + w+) / 2 = (1 - e)/2 impulse w- <= 0.
// pull: the change of the velocity by gravity in a step, < 0 towards the surface [m/s]. A bounce
// that it would turn round within the step is none: the contact rests. The other forces do not
// count: those of a stiff body under impact would end every bounce.
inline double velocity_after_impact(double before, double pull, double restitution) {
  const double after = restitution * std::max(0.0, -before);
  return after > -pull ? after : 0.0;
}

}  // namespace sinew
