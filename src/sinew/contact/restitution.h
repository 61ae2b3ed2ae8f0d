// The bounce of a contact in an explicit step: its flight along the normal, as a pure function on
// plain values. docs/methods/ground.md.
#pragma once

#include <algorithm>
#include <cmath>

namespace sinew {

// The motion along the normal after an impact.
struct Rebound {
  double gap = 0.0;       // at the end of the step [m]
  double velocity = 0.0;  // half-step velocity after the step [m/s]
  double left = 0.0;      // time of the step after the impact [s]
  double loss = 0.0;      // kinetic energy lost per mass [J/kg]
};

// gap [m], velocity [m/s]: the prediction at the end of a step of length h; a: the acceleration
// along the normal [m/s2]. It is constant within the step, so the flight is a parabola and the time
// of impact is exact: a ball that bounces with restitution 1 keeps its height. A contact whose gap
// would close again within the step is at rest.
inline Rebound rebound(double gap, double velocity, double a, double h, double restitution) {
  const double start_gap = std::max(0.0, gap - h * velocity);
  const double v0 = velocity - 0.5 * h * a;  // at the start of the step
  const double impact = -std::sqrt(std::max(0.0, v0 * v0 - 2.0 * a * start_gap));
  const double mean = 0.5 * (v0 + impact);
  const double flight = mean < 0.0 ? std::clamp(-start_gap / mean, 0.0, h) : 0.0;
  const double away = -restitution * impact;

  Rebound r;
  r.left = h - flight;
  r.gap = away * r.left + 0.5 * a * r.left * r.left;
  r.velocity = away + a * (r.left - 0.5 * h);
  r.loss = 0.5 * (impact * impact - away * away);
  if (r.gap <= 1e-12 * std::abs(a) * h * h) {  // up to rounding
    r.gap = 0.0;
    r.velocity = 0.0;
    r.loss = start_gap > 0.0 ? 0.5 * impact * impact : 0.0;
  }
  return r;
}

}  // namespace sinew
