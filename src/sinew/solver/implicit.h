// Implicit steps: stable for any step length. docs/methods/implicit.md.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <span>

#include "sinew/forces/force_evaluator.h"
#include "sinew/model/controls.h"
#include "sinew/model/state.h"
#include "sinew/solver/linear_solver.h"
#include "sinew/solver/step_report.h"
#include "sinew/solver/stepper_kind.h"

namespace sinew {

struct ImplicitOptions {
  Scheme scheme = Scheme::tr_bdf2;
  double tolerance = 1e-6;  // see NewtonReport::residual
  int max_newton = 50;      // Newton steps before the step is cut in half
  bool single = false;      // forces in single precision if may_take_single()
  int most_cuts = 10;       // times that a step is cut in half before it is given up
  Deadline deadline = {};   // then the current iterate becomes the step, whatever its residual
  const std::atomic<bool>* stop = nullptr;  // true: the step is not taken, StepReport::stopped
};

// Whether steps with this tolerance may use forces in single precision: the tolerance is coarse
// enough, and the model has no contacts and no limits.
bool may_take_single(const Model& model, double tolerance);

class ImplicitStepper {
 public:
  explicit ImplicitStepper(const Model& model);

  // Advances the state by h [s] > 0. Backward Euler: x is the minimum of
  //
  //   |x - y|_M^2 / (2 h^2) + E(x) + (x - x_n) . C (x - x_n) / (2 h),   y = x_n + h v_n,
  //
  // E all energies with pins, loads and obstacles at the time t + h, C the dashpots in their
  // directions at x_n; then v = (x - x_n) / h (Martin et al. 2011). The other schemes take two such
  // stages of length d from other positions and velocities:
  //
  //   TR-BDF2 (Bank et al. 1985), g = 2 - sqrt(2), d = g h / 2: the trapezoidal rule over g h, from
  //   x_n + d v_n and v_n + d a_n, gives x_1, v_1; then from (x_1, v_1) / (g (2 - g)) less
  //   (x_n, v_n) (1 - g)^2 / (g (2 - g));
  //   SDIRK2 (Alexander 1977), g = 1 - sqrt(1/2), d = g h: from x_n and v_n gives v_1; then from
  //   x_n + (1 - g) h v_1 and v_n + (1 - g)/g (v_1 - v_n).
  //
  // All schemes are L-stable. Dashpots and drag use the velocity at the end of the stage.
  //
  // Contacts, with friction, and limits hold at the end of the step (solver/constraints.h). A step
  // in which one of them acts is a step of backward Euler: a second stage would carry on the change
  // of velocity by an impact in the first one, multiplied (SDIRK2: by (1 - g)/g = 2.4), and throw
  // the body back. Impacts are plastic for any restitution.
  //
  // A tangled body (forces/inversion_recovery.h) is pulled back towards its rest shape instead.
  //
  // If Newton's method does not converge, the step is cut in half, up to ten times. Throws
  // Error(diverged) if that is not enough. With a deadline the result is the iterate of Newton's
  // method at that time, and no step is cut; its objective is below that of the positions before
  // the step.
  StepReport step(double h, const Controls& controls, const ImplicitOptions& options, State& state);

  // Factors the preconditioner of steps of length h, before a deadline counts.
  void prepare(double h, const Controls& controls, const ImplicitOptions& options);

  // Evaluates forces in double precision.
  ForceEvaluator& forces() { return forces_; }

 private:
  StepReport advance(double h, const Controls& controls, const ImplicitOptions& options,
                     State& state);
  StepReport recover(std::span<const Index> tangled, double h, const Controls& controls,
                     const ImplicitOptions& options, State& state);
  bool try_step(double h, const Controls& controls, const ImplicitOptions& options, State& state,
                StepReport& report);
  bool tr_bdf2(double h, const Controls& controls, const ImplicitOptions& options, State& state,
               StepReport& report);
  bool sdirk2(double h, const Controls& controls, const ImplicitOptions& options, State& state,
              StepReport& report);
  bool backward_euler(double h, const Controls& controls, const ImplicitOptions& options,
                      State& state, StepReport& report);
  ForceEvaluator& evaluator(const ImplicitOptions& options);
  std::optional<Field> solve(const Field& from, const Field& velocity, double h, const Field& path,
                             double path_time, const Controls& controls,
                             const ImplicitOptions& options, State& state, StepReport& report);

  const Model& model_;
  std::shared_ptr<const PackedLayout> layout_;
  ForceEvaluator forces_;                    // in double precision
  std::optional<ForceEvaluator> in_single_;  // created at the first use
  LinearSolver linear_;
  double constrained_inertia_ = 0.0;  // inertia for which constraints_ was created
  std::unique_ptr<Constraints> constraints_;
};

}  // namespace sinew
