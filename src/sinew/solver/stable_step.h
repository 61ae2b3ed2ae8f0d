// The largest step for which the explicit stepper is stable. docs/methods/stable-step.md.
#pragma once

#include <string>
#include <vector>

#include "sinew/forces/force_evaluator.h"
#include "sinew/model/controls.h"
#include "sinew/model/state.h"

namespace sinew {

struct StableStep {
  double step = 0.0;       // h_c [s]; infinity where nothing can move
  double omega_max = 0.0;  // angular frequency of the mode that limits the step [rad/s]
  double zeta = 0.0;       // its damping ratio [-]
  Index stiffest = -1;     // spring with the largest k / m_red; -1: none has a stiffness
  int iterations = 0;      // products of Lanczos taken
  std::vector<Vec3> mode;  // M^1/2 times the mode that limits the step, of unit norm (nodes)
};

// h_c at positions x. A step of the stepper in verlet.h is stable for every mode u (u.Mu = 1) with
// (h^2 u.Ku + 2 h u.Cu) <= 4; for one mode that is h_c = (2/omega)(sqrt(1 + zeta^2) - zeta). So h_c
// is where the largest eigenvalue of M^-1 (h^2 K + 2 h C) reaches 4: found by Newton's method on h
// with Lanczos inside, matrix-free, every estimate on the safe side by its residual.
//
StableStep find_stable_step(const Model& model, const Controls& controls,
                            const std::vector<Vec3>& x, ForceEvaluator& forces);

// The same during a run, at the price of two steps in double precision or five in single: three
// products of Lanczos that start from `mode`, the mode found before, with the step `h` now taken;
// `mode` becomes the better one. Returns a stable step, which with damping may be shorter than the
// largest. It misses what three products do not resolve: leave a margin.
double watch_stable_step(const Model& model, const Controls& controls, const std::vector<Vec3>& x,
                         double h, std::vector<Vec3>& mode, ForceEvaluator& forces);

// "spring 12 (body beam, node 3 to body beam, node 4): k = ..., l0 = ..., c = ...".
std::string describe_spring(const Model& model, Index spring);

}  // namespace sinew
