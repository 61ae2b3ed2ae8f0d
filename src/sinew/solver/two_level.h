// The preconditioner of Newton's linear systems: the diagonal block of every node, and affine
// motions of groups of nodes. docs/methods/linear-solver.md.
#pragma once

#include <memory>
#include <vector>

#include "sinew/base/float4.h"
#include "sinew/model/model.h"
#include "sinew/solver/block_cholesky.h"
#include "sinew/solver/newton.h"

namespace sinew {

// P^-1 = D^-1 + R Q (Q^T K_0 Q)^-1 Q^T R^T: K_0 the tangent at rest, Q the affine motions of each
// group about its rest shape, R the groups' rotations since then, D the diagonal blocks R D_0 R^T
// of K_0 and those of contacts, limits and terms now. So the small system is factored once and
// follows the body's rotation.
class TwoLevel {
 public:
  // Groups the free nodes by body and by the stiffest region they belong to, then bisects the
  // groups across the longest side until each has at most `group_size` nodes.
  explicit TwoLevel(const Model& model, Index group_size = 0);  // 0: from the number of nodes

  // Finds D_0, and factors Q^T K_0 Q, for the objective at rest.
  void factor(const Objective& rest, double time);

  // Finds the groups' rotations from rest to x. outer: the diagonal blocks that are added to D
  // [N/m] (nodes), or empty; those of terms at rest must not be in D_0.
  void turn(const Field& x, const std::vector<Mat3>& outer);

  // z = P^-1 r; returns r . z.
  double apply(const Field4& r, Field4& z);

  Index group_count() const { return static_cast<Index>(centre_.size()); }

 private:
  const Model& model_;
  std::vector<Index> group_;            // of each node, -1: prescribed motion (nodes)
  std::vector<Index> start_, nodes_;    // of each group (groups + 1)
  std::vector<Vec3> centre_;            // at rest [m] (groups)
  std::vector<Eigen::Vector4f> shape_;  // 1 and the three linear motions of each node [-] (nodes)
  std::vector<Mat3> rotation_;          // (groups)
  std::vector<Mat3> diagonal_;          // D_0 [N/m] (nodes), without the terms
  std::vector<Mat3> inverse_;           // D_0^-1 [m/N] (nodes)
  std::vector<Block3> inverse_now_;     // D^-1 [m/N] (nodes), 0 for prescribed motion
  std::unique_ptr<BlockCholesky> factor_;
  std::vector<CoarseVector> coarse_;  // scratch (groups)
};

}  // namespace sinew
