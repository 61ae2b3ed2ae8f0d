// Newton's linear systems: conjugate gradients on the assembled tangent, with the two-level
// preconditioner. docs/methods/linear-solver.md.
#pragma once

#include <memory>

#include "sinew/solver/newton.h"
#include "sinew/solver/tangent_matrix.h"
#include "sinew/solver/two_level.h"

namespace sinew {

class LinearSolver {
 public:
  explicit LinearSolver(const Model& model);

  // Factors the preconditioner for the objective's tangent at rest; nothing where it is factored
  // for the same model and inertia.
  void factor(const Objective& objective, double time);

  // Makes the tangent K of the objective at positions x the matrix, and factors the preconditioner
  // if need be. `tets` are those at x.
  void assemble(const Objective& objective, const Field& x, double time, const TetState& tets);

  // An approximate solution p of K p = r, 0 on nodes whose motion is given: stops at
  // |K p - r| <= forcing |r|, after `most` products, after the product at which the deadline
  // passes, or where K turns out not to be positive; p is then the best so far, and r . p > 0 all
  // the same (Steihaug 1983). Returns the products taken.
  int solve(const Field& r, double forcing, int most, const Deadline& deadline, Field& p);

  // What the tets can pull and resist with, as sums over them of (mu V^(2/3))^2 [N2] and of
  // (mu V^(1/3))^2 [N2/m2].
  double pull2() const { return pull2_; }
  double resistance2() const { return resistance2_; }

 private:
  bool is_factored(const Objective& objective) const;

  TangentMatrix matrix_;
  TwoLevel preconditioner_;
  const Model* factored_model_ = nullptr;  // what preconditioner_ was factored for
  float factored_inertia_ = -1.0f;
  double pull2_ = 0.0;
  double resistance2_ = 0.0;
  Field4 r_, z_, d_, q_, p_;  // residual, P^-1 r, direction, K d, solution
};

}  // namespace sinew
