// The rest state: all forces on the free nodes vanish. docs/methods/static.md.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "sinew/forces/force_evaluator.h"
#include "sinew/forces/term.h"
#include "sinew/model/controls.h"
#include "sinew/model/state.h"
#include "sinew/solver/linear_solver.h"
#include "sinew/solver/step_report.h"

namespace sinew {

struct StaticProgress {
  int load_step = 0;      // 1, 2, ...
  double load = 0.0;      // finished share of the change of loads and pins [-]
  int newton = 0;         // Newton steps so far, in total
  double residual = 0.0;  // see StepReport
};

struct StaticOptions {
  double tolerance = 1e-6;  // residual to reach [-]
  int max_newton = 100;     // Newton steps within a load step before it is cut in half
  int most_newton = 500;    // in total; no load step is repeated after them
  // In total, after the first failure: Hessian products times nodes. About 7 s.
  double most_work = 5e7;
  bool finds_limit_load = true;  // where there is no rest state, for the message
  int min_load_steps = 1;        // pins that rotate far take more load steps (one per 20 degrees)
  const std::atomic<bool>* stop = nullptr;  // ends after the current Newton step
  std::function<void(const StaticProgress&)> on_progress;
};

class StaticSolver {
 public:
  explicit StaticSolver(const Model& model);

  // Moves the state to rest under the pins and loads at the time `time` [s], starting from its
  // positions: Newton's method with conjugate gradients and a line search on the energy. Velocities
  // become zero, state.time = time. Dashpots and drag have no effect.
  //
  // A body that is tangled at the start (forces/inversion_recovery.h) starts from its rest shape
  // instead, moved rigidly to its place.
  //
  // Contacts, without friction, and limits hold in the rest state (solver/constraints.h). A body
  // that only a hard plane holds, the ground or an obstacle, is first moved along the plane's
  // normal onto it. Along the plane it stays as near to its place as possible. Bodies that lie on
  // each other, or that friction holds, sink to rest from their place instead, with friction
  // (rest_by_contact.cpp).
  //
  // If Newton's method does not converge, pins and loads are applied in smaller steps; after two
  // cuts dynamic relaxation is tried once. Throws Error(input) if nothing holds a body against the
  // forces on it, and Error(diverged) if no rest state is found, with the share of the loads that
  // has one (solver/limit_load.h). If options.stop ends the search, the state is the best so far.
  StepReport solve(const Controls& controls, double time, const StaticOptions& options,
                   State& state);

  // Solves K u = rhs for the free nodes with the tangent at `at` by conjugate gradients, to
  // |K u - rhs| <= tolerance |rhs|. u of the other nodes is kept and acts as a prescribed
  // displacement. Returns the number of products.
  int solve_tangent(const Configuration& at, const std::vector<Vec3>& rhs, double tolerance,
                    std::vector<Vec3>& u);

  // Evaluates forces in double precision.
  ForceEvaluator& forces() { return forces_; }

 private:
  NewtonReport rest_by_contact(const Controls& controls, const StaticOptions& options,
                               StaticProgress progress, State& state);
  StepReport settle_by_contact(const Controls& controls, const StaticOptions& options,
                               const State& start, StepReport report, State& state);
  [[noreturn]] void throw_no_rest(const Controls& controls, double time,
                                  const StaticOptions& options, const State& start,
                                  const StepReport& report) const;
  NewtonReport relax_dynamically(const Controls& controls, double start_time, double time,
                                 const StaticOptions& options, StaticProgress progress,
                                 State& state);
  int move_pins_to(const Controls& controls, double start_time, double time, double share,
                   State& state);
  NewtonReport settle(Objective objective, const NewtonOptions& options, ForceEvaluator& forces,
                      State& state);

  const Model& model_;
  std::shared_ptr<const PackedLayout> layout_;
  ForceEvaluator forces_;
  std::optional<ForceEvaluator> in_single_;  // on the way to a residual of 1e-3; none: not allowed
  double proximal_stiffness_ = 0.0;          // see settle() [1/s2]; 0 if every body is held
  LinearSolver linear_;
  Constraints constraints_;
  Index contacts_at_rest_ = 0;  // of rest_by_contact()
  // The model with a less stiff volume, if that helps; else none.
  struct Softened {
    Model model;
    ForceEvaluator forces{model, Precision::double_};
  };
  std::unique_ptr<Softened> softened_;
};

}  // namespace sinew
