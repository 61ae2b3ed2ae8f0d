// The rest state: where all forces on the free nodes vanish. docs/methods/static.md.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>

#include "sinew/forces/force_evaluator.h"
#include "sinew/forces/term.h"
#include "sinew/model/controls.h"
#include "sinew/model/state.h"
#include "sinew/solver/linear_solver.h"
#include "sinew/solver/step_report.h"

namespace sinew {

struct StaticProgress {
  int load_step = 0;      // 1, 2, ...
  double load = 0.0;      // share of the way to the new loads and pins that is done [-]
  int newton = 0;         // Newton steps so far, in all
  double residual = 0.0;  // see StepReport
};

struct StaticOptions {
  double tolerance = 1e-6;  // residual to reach [-]
  int max_newton = 100;     // Newton steps within a load step before it is cut in half
  int most_newton = 500;    // in all; no load step is begun anew after them
  int min_load_steps = 1;   // pins that turn far get more of themselves (20 degrees each)
  const std::atomic<bool>* stop = nullptr;  // ends after the Newton step under way
  std::function<void(const StaticProgress&)> on_progress;
};

class StaticSolver {
 public:
  explicit StaticSolver(const Model& model);

  // Moves the state to rest under the pins and loads of the time `time` [s], starting from where it
  // is: Newton's method with conjugate gradients and a line search on the energy. Velocities become
  // zero, state.time = time. Dashpots and drag play no part.
  //
  // A body that is tangled at the start (forces/inversion_recovery.h) starts from its rest shape
  // instead, moved rigidly to where it is.
  //
  // Contacts, without friction, and limits hold in it (solver/constraints.h). A body that only a
  // hard plane holds, the ground or an obstacle, is put down on it first, straight along its
  // normal, and then keeps its place along the plane as nearly as it can.
  //
  // Where Newton's method does not converge, pins and loads are applied in smaller steps, and after
  // two cuts dynamic relaxation is tried once.
  // Throws Error(input) where a body has nothing to hold it against the forces on it, and
  // Error(diverged) where no rest state is found.
  // Where options.stop ends it, the state is the best so far.
  StepReport solve(const Controls& controls, double time, const StaticOptions& options,
                   State& state);

  // Solves K u = rhs for the free nodes with the tangent there by conjugate gradients, to
  // |K u - rhs| <= tolerance |rhs|; u of the others is kept as given and acts as a prescribed
  // displacement. Returns the products taken.
  int solve_tangent(const Configuration& at, const std::vector<Vec3>& rhs, double tolerance,
                    std::vector<Vec3>& u);

  // In double precision.
  ForceEvaluator& forces() { return forces_; }

 private:
  NewtonReport relax_dynamically(const Controls& controls, double start_time, double time,
                                 const StaticOptions& options, StaticProgress progress,
                                 State& state);
  int move_pins_to(const Controls& controls, double start_time, double time, double share,
                   State& state);
  NewtonReport settle(Objective objective, const NewtonOptions& options, ForceEvaluator& forces,
                      State& state);

  const Model& model_;
  ForceEvaluator forces_;
  double nudge_ = 0.0;  // see settle() [1/s2]; 0 where no body rests on a plane alone
  LinearSolver linear_;
  Constraints constraints_;
  // The model with less stiff volume, where that helps; else none.
  struct Softened {
    Model model;
    ForceEvaluator forces{model, Precision::double_};
  };
  std::unique_ptr<Softened> softened_;
};

}  // namespace sinew
