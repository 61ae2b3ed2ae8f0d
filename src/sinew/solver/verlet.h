// Position Verlet: one explicit step. docs/methods/verlet.md.
#pragma once

#include <optional>
#include <vector>

#include "sinew/contact/explicit_contacts.h"
#include "sinew/forces/force_evaluator.h"
#include "sinew/forces/volume_limit.h"
#include "sinew/model/controls.h"
#include "sinew/model/state.h"
#include "sinew/solver/step_report.h"

namespace sinew {

class VerletStepper {
 public:
  // The model must outlive the object.
  VerletStepper(const Model& model, Precision precision);

  // Advances the state by h [s] > 0.
  //
  //   x(t+h) = 2 x(t) - x(t-h) + a(t) h^2,   v(t) = (x(t+h) - x(t-h)) / 2h
  //
  // stored as positions and half-step velocities w = (x(t) - x(t-h)) / h, which is equivalent and
  // more accurate:  w += a (h_last + h)/2,  x += h w.  The first step, with h_last = 0 and w = v0,
  // is the start x(-h) = x0 - h v0 + a0 h^2/2. Dashpots and drag use w, the half-step velocity.
  // Tangled bodies are pulled back to their rest shape (forces/inversion_recovery.h); the change of
  // energy counts as work put in. The motion is followed by the contacts, then by the limits;
  // velocities follow the corrected positions. A step may differ in length from the one before.
  //
  // Throws Error(diverged) if a position is not finite or beyond 1e9 m, and names body, node,
  // spring and time; the state is then the broken one.
  //
  // StepReport::limits_met is false if springs exceed their limit after the last sweep, or cells
  // their volume limit after the projections. step() does not set stable_step.
  StepReport step(double h, const Controls& controls, State& state);

  // Square of the highest angular frequency that the guard of tets near inversion adds, for the
  // last forces [1/s2] (forces/volume.h); 0 before the first step.
  double guard_frequency2() const { return guard_frequency2_; }

  ForceEvaluator& forces() { return forces_; }

 private:
  double heat_of_impacts(const State& state);

  const Model& model_;
  ForceEvaluator forces_;
  std::optional<ExplicitContacts> contacts_;  // only if something in the model can touch
  std::vector<Vec3> before_;                  // positions before the move [m] (nodes)
  std::vector<Vec3> velocity_before_;         // half-step velocities before it [m/s] (nodes)
  std::vector<Vec3> mean_velocity_;           // scratch [m/s] (nodes)
  VolumeLimit volume_limit_;
  double guard_frequency2_ = 0.0;
};

}  // namespace sinew
