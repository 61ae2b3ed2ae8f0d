// What a step took and what it left.
#pragma once

#include "sinew/base/vec.h"
#include "sinew/model/material.h"

namespace sinew {

// sim/run_counters.h says how these add up over a run.
struct StepReport {
  int newton = 0;      // steps of Newton's method
  int products = 0;    // Hessian products they took
  int load_steps = 0;  // of rest states: steps that pins and loads were brought on in
  int cuts = 0;        // times that the step was cut in half
  // The largest left [-]: |f| over the free nodes divided by the norm of what they carry: the
  // larger of the outer forces on the free nodes and the material's forces on the pinned ones
  // (reactions); where both vanish, 1e-5 of what the material pulls with at a strain of one.
  double residual = 0.0;
  bool ran_out = false;           // of time, see Interrupt::deadline
  bool stopped = false;           // by Interrupt::stop: the step is not done
  Index contacts = 0;             // places that touch at the end
  double deepest = 0.0;           // a place was left inside what it touched [m]
  double friction = 0.0;          // work of friction in contacts [J]
  int limit_sweeps = 0;           // sweeps that moved a spring
  bool limits_met = true;         // the ground and the limits hold to their tolerances
  int recovered = 0;              // bodies with inversion recovery (forces/inversion_recovery.h)
  double stable_step = no_limit;  // what the forces of this step allow the next one [s]
};

}  // namespace sinew
