// The largest step for which the explicit stepper is stable. docs/methods/stable-step.md.
#pragma once

#include <string>
#include <vector>

#include "sinew/forces/force_evaluator.h"
#include "sinew/model/controls.h"
#include "sinew/model/state.h"

namespace sinew {

struct StableStep {
  double step = 0.0;       // h_c [s]; infinity if nothing can move
  double omega_max = 0.0;  // angular frequency of the mode that limits the step [rad/s]
  double zeta = 0.0;       // its damping ratio [-]
  Index stiffest = -1;     // spring with the largest k / m_red; -1: none has a stiffness
  int iterations = 0;      // products of the Lanczos method
  std::vector<Vec3> mode;  // M^1/2 times the mode that limits the step, with unit norm (nodes)
};

// h_c at positions x. A step of the stepper in verlet.h is stable if (h^2 u.Ku + 2 h u.Cu) <= 4 for
// every mode u (u.Mu = 1); for one mode that is h_c = (2/omega)(sqrt(1 + zeta^2) - zeta). So at h_c
// the largest eigenvalue of M^-1 (h^2 K + 2 h C) is 4. h_c is found by Newton's method on h with
// the Lanczos method inside, matrix-free. The residual makes every estimate a safe one. `near`: a
// step near it [s] and a start for the mode (nodes), with random values where the model is new:
// fewer products are needed.
struct NearStep {
  double step = 0.0;
  std::vector<Vec3> mode;
};
StableStep find_stable_step(const Model& model, const Controls& controls,
                            const std::vector<Vec3>& x, ForceEvaluator& forces,
                            const NearStep* near = nullptr);

// The same during a run, at the cost of two steps in double precision or five in single: three
// Lanczos products that start from `mode`, the mode found before, with the current step `h`; `mode`
// becomes the better one. Returns a stable step; with damping it may be shorter than the largest.
// It misses modes that three products do not resolve: leave a margin.
double watch_stable_step(const Model& model, const Controls& controls, const std::vector<Vec3>& x,
                         double h, std::vector<Vec3>& mode, ForceEvaluator& forces);

// The share of the stable step up to which explicit steps keep the energy of a model: 1 if damping
// removes what the fast modes gain, less if any restitution is above 0 or a body has no damping.
// Verlet's energy oscillates with a relative size of (omega h)^2 / 4; near the stable step,
// h omega = 2, an impact that excites all modes leaves an error as large as their energy.
double accurate_share(const Model& model);

// The description of a spring in messages:
// "spring 12 (body beam, node 3 to body beam, node 4): k = ..., l0 = ..., c = ...".
std::string describe_spring(const Model& model, Index spring);

}  // namespace sinew
