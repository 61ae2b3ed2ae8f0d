// The second derivative of the objective as products in single precision: a Newton direction needs
// few digits, and half the bytes take half the time. The force of Newton's method is in double
// precision. docs/methods/linear-solver.md.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "sinew/base/float4.h"
#include "sinew/forces/packed_tangent.h"
#include "sinew/model/model.h"
#include "sinew/solver/newton.h"

namespace sinew {

// K u = the material's (forces/packed_tangent.h) + D u + sum_p w_p T_p sum_q w_q u_q
//
// D: inertia and drag. T_p, w_p: block and weights of a contact, of a limited spring, or of an
// element of a term (forces/term.h).
class TangentOperator {
 public:
  TangentOperator(const Model& model, std::shared_ptr<const PackedLayout> layout);

  // Takes K at positions x and `time` for objective.model: the constructor's model, or one that
  // differs from it in volume stiffness only. `forces` are those of objective.model.
  void assemble(const Objective& objective, const Field& x, double time, ForceEvaluator& forces);

  // out = K u (nodes), 0 for prescribed motion; u must be 0 there. Returns u . K u.
  double times(const Field4& u, Field4& out);

  // The diagonal blocks of contacts, limits and terms [N/m] (nodes); empty: there are none.
  const std::vector<Mat3>& outer_diagonal() const { return outer_diagonal_; }

 private:
  struct Element {
    Range parts;   // of node_ and weight_, free nodes
    Block3 block;  // [N/m]
  };
  void add(std::span<const Index> nodes, std::span<const double> weights, const Mat3& block);
  void add_limits(const Constraints& constraints);

  const Model& model_;
  PackedTangent material_;
  bool resolved_;           // resolved_in_single()
  std::vector<float> own_;  // D [N/m] (nodes), -1: prescribed motion
  std::vector<Element> elements_;
  std::vector<Index> node_;
  std::vector<float> weight_;
  std::vector<Mat3> outer_diagonal_;
};

}  // namespace sinew
