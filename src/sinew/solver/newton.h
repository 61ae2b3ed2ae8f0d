// Newton's method with conjugate gradients and a line search, for rest states and implicit
// steps. docs/methods/static.md, docs/methods/implicit.md.
#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include "sinew/forces/force_evaluator.h"
#include "sinew/model/controls.h"
#include "sinew/model/state.h"
#include "sinew/solver/constraints.h"
#include "sinew/solver/deadline.h"
#include "sinew/solver/field.h"

namespace sinew {

class LinearSolver;

// The function of the positions x of the free nodes that is minimised: the potential energy of the
// model at state.time, plus
//   share sum_i f_i . (x_i - X_i)            a dead force that is removed in load steps
//   inertia/2 sum_i m_i |x_i - y_i|^2        of an implicit step, inertia = 1/h^2
//   rate/2 (x - from) . C (x - from)         dashpots, viscosity and drag over that step,
//                                            rate = 1/h, with dashpots and viscosity at `lagged`
//   the energies of `constraints` for their current multipliers
struct Objective {
  const Model& model;
  const Controls& controls;
  const Field* dead_force = nullptr;  // [N]
  double share = 0.0;                 // [-]
  double inertia = 0.0;               // [1/s2]
  const Field* inertial = nullptr;    // y [m]
  double rate = 0.0;                  // [1/s]
  const Field* from = nullptr;        // [m]
  const Field* lagged = nullptr;      // [m]
  Constraints* constraints = nullptr;
};

// Its value [J]. state.half_velocity must be zero here and below.
double objective_value(const Objective& objective, const State& state, ForceEvaluator& forces);

struct ObjectiveForce {
  Field free;         // minus the gradient of the objective on the free nodes, 0 on the others [N]
  Field nodal_force;  // forces of the model and the constraints on all nodes [N]
};
ObjectiveForce objective_force(const Objective& objective, const State& state,
                               ForceEvaluator& forces);

struct NewtonProgress {
  int newton = 0;         // steps so far
  double residual = 0.0;  // |force| / scale [-]
};

struct NewtonOptions {
  double tolerance = 1e-6;  // residual to reach [-]
  int most = 100;           // Newton steps
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const NewtonProgress&)> on_progress;
  // The current iterate is returned at this time. One product and its line search always run.
  Deadline deadline = {};
};

struct NewtonReport {
  bool rests = false;     // the residual is within the tolerance
  bool stopped = false;   // by options.stop
  bool ran_out = false;   // the deadline passed, see NewtonOptions::deadline
  int newton = 0;         // steps taken
  int products = 0;       // Hessian products of the conjugate gradients
  double force = 0.0;     // remaining |force| [N]
  double residual = 0.0;  // relative to the forces that are carried [-]
  bool within = true;     // the constraints hold (minimise_augmented_lagrangian)
  Field nodal_force;      // forces of the model and the constraints on all nodes at the end [N]
};

// Moves the free nodes of the state to a minimum near their positions.
//
// The residual is |force| divided by the norm of the carried forces: the largest of the outer
// forces and the inertial forces on the free nodes, the model's forces on the other nodes, and 1e-5
// of the material's forces at a strain of one.
NewtonReport minimise(const Objective& objective, LinearSolver& linear,
                      const NewtonOptions& options, ForceEvaluator& forces, State& state);

// Also finds the multipliers of objective.constraints: minimises for given multipliers, takes the
// forces found as the new multipliers, and repeats this until the constraints hold and the forces
// are in equilibrium.
NewtonReport minimise_augmented_lagrangian(const Objective& objective, LinearSolver& linear,
                                           const NewtonOptions& options, ForceEvaluator& forces,
                                           State& state);

void keep_free(const Model& model, Field& f);  // 0 on the nodes with prescribed motion

}  // namespace sinew
