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
//   share sum_i f_i . (x_i - X_i)            a dead force that is taken away in load steps
//   inertia/2 sum_i m_i |x_i - y_i|^2        of an implicit step, inertia = 1/h^2
//   rate/2 (x - from) . C (x - from)         dashpots, viscosity and drag over that step,
//                                            rate = 1/h, with dashpots and viscosity as at `lag`
//   the energies of `constraints` for their multipliers as they are
struct Objective {
  const Model& model;
  const Controls& controls;
  const Field* dead_force = nullptr;  // [N]
  double share = 0.0;                 // [-]
  double inertia = 0.0;               // [1/s2]
  const Field* inertial = nullptr;    // y [m]
  double rate = 0.0;                  // [1/s]
  const Field* from = nullptr;        // [m]
  const Field* lag = nullptr;         // [m]
  Constraints* constraints = nullptr;
};

// Its value [J]. state.half_velocity has to be zero here and below.
double objective_value(const Objective& objective, const State& state, ForceEvaluator& forces);

struct ObjectiveForce {
  Field free;  // minus the gradient of the objective on the free nodes, 0 on the others [N]
  Field pull;  // what the model and the constraints pull all nodes with [N]
};
ObjectiveForce objective_force(const Objective& objective, const State& state,
                               ForceEvaluator& forces);

// v . C v of dashpots and viscosity as at positions x, and drag [W], v of all nodes.
double damping_power(const Model& model, const Field& x, const Field& v);

struct NewtonProgress {
  int newton = 0;         // steps so far
  double residual = 0.0;  // |force| / scale [-]
};

struct NewtonOptions {
  double tolerance = 1e-6;  // residual to reach [-]
  int most = 100;           // Newton steps
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const NewtonProgress&)> on_progress;
  // The current iterate is returned. One product and the search along its direction always run.
  Deadline deadline = {};
};

struct NewtonReport {
  bool rests = false;     // the residual was reached
  bool stopped = false;   // by options.stop
  bool ran_out = false;   // of time, see options.deadline
  int newton = 0;         // steps taken
  int products = 0;       // Hessian products taken by the conjugate gradients
  double force = 0.0;     // |force| left [N]
  double residual = 0.0;  // as a share of what the body carries [-]
  bool within = true;     // the constraints hold (minimise_augmented_lagrangian)
  Field pull;             // what the model and the constraints pull all nodes with at the end [N]
};

// Moves the free nodes of the state to the minimum near where they are.
//
// The residual is |force| over the norm of what is carried: the largest of the outer forces and the
// inertial ones on the free nodes, the model's forces on the others, and 1e-5 of what the material
// pulls with at a strain of one.
NewtonReport minimise(const Objective& objective, LinearSolver& linear,
                      const NewtonOptions& options, ForceEvaluator& forces, State& state);

// Finds the multipliers of objective.constraints as well: minimises for given multipliers, takes
// the pushes found as the new multipliers, and repeats this until the conditions hold and the
// forces rest.
NewtonReport minimise_augmented_lagrangian(const Objective& objective, LinearSolver& linear,
                                           const NewtonOptions& options, ForceEvaluator& forces,
                                           State& state);

void keep_free(const Model& model, Field& f);  // 0 on the nodes whose motion is given

}  // namespace sinew
