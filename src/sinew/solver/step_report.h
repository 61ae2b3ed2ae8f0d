// The cost and the results of a step.
#pragma once

#include "sinew/base/vec.h"
#include "sinew/model/material.h"

namespace sinew {

// sim/run_counters.h defines how these add up over a run.
struct StepReport {
  int newton = 0;      // steps of Newton's method
  int products = 0;    // Hessian products of Newton's method
  int load_steps = 0;  // of rest states: load steps for pins and loads
  int cuts = 0;        // the number of times the step was cut in half
  // The largest residual [-]: |f| over the free nodes divided by the norm of the carried forces:
  // the larger of the outer forces on the free nodes and the material's forces on the pinned nodes
  // (reactions); if both vanish, 1e-5 of the material's forces at a strain of one.
  double residual = 0.0;
  bool ran_out = false;           // the deadline passed, see Interrupt::deadline
  bool stopped = false;           // by Interrupt::stop: the step is not complete
  Index contacts = 0;             // contacts at the end
  double deepest = 0.0;           // the deepest remaining penetration of a contact [m]
  double friction = 0.0;          // work of friction in contacts [J]
  double led_out = 0.0;           // work of contacts and limits that lead back to their bounds [J]
  int limit_sweeps = 0;           // sweeps that moved a spring
  bool limits_met = true;         // the ground and the limits hold to their tolerances
  int recovered = 0;              // bodies under inversion recovery (forces/inversion_recovery.h)
  double recovery_work = 0.0;     // work of inversion recovery [J]
  double stable_step = no_limit;  // the longest next step that the forces of this step allow [s]
};

}  // namespace sinew
