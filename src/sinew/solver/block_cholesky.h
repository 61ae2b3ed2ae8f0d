// Cholesky's factorisation of a sparse symmetric matrix of dense 12 x 12 blocks.
#pragma once

#include <Eigen/Core>
#include <map>
#include <vector>

#include "sinew/base/vec.h"

namespace sinew {

inline constexpr int coarse_size = 12;  // unknowns per block
using CoarseBlock = Eigen::Matrix<double, coarse_size, coarse_size>;
using CoarseVector = Eigen::Matrix<float, coarse_size, 1>;

class BlockCholesky {
 public:
  // The lower triangle by columns: column[j] maps rows i >= j to blocks. Fill-in blocks are added.
  // If a pivot is not positive definite, its diagonal is raised until it is: the factors then
  // belong to a positive definite matrix near the given one.
  explicit BlockCholesky(std::vector<std::map<Index, CoarseBlock>> column);

  // Solves A x = b in place, in single precision.
  void solve(std::vector<CoarseVector>& b) const;

 private:
  using Single = Eigen::Matrix<float, coarse_size, coarse_size>;
  std::vector<Index> start_, row_;  // blocks below the diagonal, column by column
  std::vector<Single> below_;       // L_ij L_jj^-1: unit lower triangular by blocks
  std::vector<Single> inverse_;     // of the blocks of the diagonal
};

}  // namespace sinew
