// Newton's law of impact in an explicit step, as a pure function on plain values.
// docs/methods/ground.md.
#pragma once

#include <algorithm>

namespace sinew {

// The smallest relative velocity along the normal with which a contact that closes may leave a step
// [m/s], by restitution: -e times the half-step velocity before the step. In the energy of Verlet's
// method, m/2 w- . w+ at the time of the positions, the impulse then does the work
//   impulse (w- + w+) / 2 = (1 - e)/2 impulse w- <= 0,
// for any number of impacts at once, so that no impact makes energy.
inline double velocity_after_impact(double before, double restitution) {
  return restitution * std::max(0.0, -before);
}

}  // namespace sinew
