// The preconditioner of Newton's linear systems: the diagonal block of every node, and affine
// motions of groups of nodes. docs/methods/linear-solver.md.
#pragma once

#include <memory>
#include <vector>

#include "sinew/model/model.h"
#include "sinew/solver/block_cholesky.h"
#include "sinew/solver/tangent_matrix.h"

namespace sinew {

// P^-1 = D^-1 + R Q (Q^T K_0 Q)^-1 Q^T R^T: D the diagonal blocks of the current K, Q the affine
// motions of each group about its rest shape, K_0 the tangent at rest, R the groups' rotations
// since then. So the small system is factored once and follows the body's rotation.
class TwoLevel {
 public:
  // Groups the free nodes by body and by the stiffest region they belong to, then bisects the
  // groups across the longest side until each has at most `group_size` nodes.
  explicit TwoLevel(const Model& model, Index group_size = 0);  // 0: from the number of nodes

  // Factors Q^T K_0 Q of a tangent assembled at rest.
  void factor(const TangentMatrix& rest);

  // Finds the groups' rotations from rest to x.
  void turn(const Field& x);

  // z = P^-1 r; returns r . z.
  double apply(const TangentMatrix& matrix, const Field4& r, Field4& z);

  Index group_count() const { return static_cast<Index>(centre_.size()); }

 private:
  const Model& model_;
  std::vector<Index> group_;            // of each node, -1: prescribed motion (nodes)
  std::vector<Index> start_, nodes_;    // of each group (groups + 1)
  std::vector<Vec3> centre_;            // at rest [m] (groups)
  std::vector<Eigen::Vector4f> shape_;  // 1 and the three linear motions of each node [-] (nodes)
  std::vector<Mat3> rotation_;          // (groups)
  std::unique_ptr<BlockCholesky> factor_;
  std::vector<CoarseVector> coarse_;  // scratch (groups)
};

}  // namespace sinew
