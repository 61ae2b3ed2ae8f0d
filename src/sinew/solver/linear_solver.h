// Newton's linear systems: conjugate gradients on products with the tangent, with the two-level
// preconditioner. docs/methods/linear-solver.md.
#pragma once

#include <atomic>
#include <memory>

#include "sinew/solver/newton.h"
#include "sinew/solver/tangent_operator.h"
#include "sinew/solver/two_level.h"

namespace sinew {

class LinearSolver {
 public:
  // layout: of the model; null: makes one.
  explicit LinearSolver(const Model& model, std::shared_ptr<const PackedLayout> layout = nullptr);

  // Factors the preconditioner for the objective's tangent at rest; does nothing if it is already
  // factored for the same model and inertia.
  void factor(const Objective& objective, double time);

  // Takes the tangent K of the objective at positions x, and factors the preconditioner if
  // necessary. `forces` are
  // those of objective.model.
  void assemble(const Objective& objective, const Field& x, double time, ForceEvaluator& forces);

  // An approximate solution p of K p = r, 0 on nodes with prescribed motion. Stops at |K p - r| <=
  // forcing |r|, after `most` products, after the product during which the deadline passes or
  // `stop` is set, or if K is not positive. In the last cases p is the best solution so far; r . p
  // > 0 always holds (Steihaug 1983). Returns the number of products.
  int solve(const Field& r, double forcing, int most, const Deadline& deadline, Field& p,
            const std::atomic<bool>* stop = nullptr);

  // The scale of the tets' forces and of their resistance, as sums over the tets of (mu V^(2/3))^2
  // [N2] and of (mu V^(1/3))^2 [N2/m2].
  double force2() const { return force2_; }
  double resistance2() const { return resistance2_; }

 private:
  bool is_factored(const Objective& objective) const;

  TangentOperator tangent_;
  TwoLevel preconditioner_;
  const Model* factored_model_ = nullptr;  // the model of the factors in preconditioner_
  float factored_inertia_ = -1.0f;
  double force2_ = 0.0;
  double resistance2_ = 0.0;
  Field4 r_, z_, d_, q_, p_;  // residual, P^-1 r, direction, K d, solution
};

}  // namespace sinew
