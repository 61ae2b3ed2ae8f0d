// Position Verlet: one explicit step. docs/methods/verlet.md.
#pragma once

#include "sinew/contact/contact_solver.h"
#include "sinew/forces/workspace.h"
#include "sinew/model/controls.h"
#include "sinew/model/state.h"

namespace sinew {

struct VerletReport {
  ContactReport contact;
  int limit_sweeps = 0;    // sweeps that moved a spring
  bool limits_met = true;  // false: springs still over their limit after the last sweep
  bool volume_met = true;  // false: cells still over their volume limit after the projections
  int righted = 0;         // tangled bodies that were led back to their rest shape
};

// Advances the state by h [s] > 0.
//
//   x(t+h) = 2 x(t) - x(t-h) + a(t) h^2,   v(t) = (x(t+h) - x(t-h)) / 2h
//
// kept as positions and half-step velocities w = (x(t) - x(t-h)) / h, which is the same to the
// letter and loses fewer digits:  w += a (h_last + h)/2,  x += h w.  The first step, with
// h_last = 0 and w = v0, is the start x(-h) = x0 - h v0 + a0 h^2/2. Dashpots and drag see w, the
// half-step velocity. Tangled bodies are righted (forces/inversion_recovery.h); what that changes
// the energy by counts as work put in. After the move come the contacts, then the limits;
// velocities follow the corrected positions. A step may differ in length from the last one.
//
// Throws Error(diverged) when a position is not finite any more or beyond 1e9 m, and names body,
// node, spring and time; the state is then the broken one.
VerletReport verlet_step(const Model& model, const Controls& controls, double h, State& state,
                         Workspace& workspace);

}  // namespace sinew
