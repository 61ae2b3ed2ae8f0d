#include "sinew/solver/block_cholesky.h"

#include <Eigen/Cholesky>

namespace sinew {

// L D L^T by blocks: column j of L is A_ij D_j^-1. It subtracts L_ij D_j L_kj^T = A_ij L_kj^T from
// the columns to its right.
BlockCholesky::BlockCholesky(std::vector<std::map<Index, CoarseBlock>> column) {
  start_.push_back(0);
  for (std::size_t j = 0; j < column.size(); ++j) {
    CoarseBlock pivot = column[j].at(static_cast<Index>(j));
    const double mean = pivot.trace() / coarse_size;
    Eigen::LLT<CoarseBlock> llt(pivot);
    for (double raise = 1e-6; llt.info() != Eigen::Success && raise < 1e6; raise *= 10.0) {
      llt.compute(pivot + (mean > 0.0 ? raise * mean : raise) * CoarseBlock::Identity());
    }
    const CoarseBlock inverse = llt.solve(CoarseBlock::Identity());
    inverse_.emplace_back(inverse.cast<float>());
    std::vector<std::pair<Index, CoarseBlock>> l;  // L_ij
    for (const auto& [i, block] : column[j]) {
      if (uz(i) != j) l.emplace_back(i, block * inverse);
    }
    for (const auto& [k, l_kj] : l) {
      for (const auto& [i, l_ij] : l) {
        if (i < k) continue;
        const auto [entry, added] = column[uz(k)].try_emplace(i);
        if (added) entry->second.setZero();
        entry->second.noalias() -= column[j].at(i) * l_kj.transpose();
      }
    }
    for (const auto& [i, l_ij] : l) {
      row_.push_back(i);
      below_.emplace_back(l_ij.cast<float>());
    }
    start_.push_back(static_cast<Index>(row_.size()));
    column[j].clear();
  }
}

void BlockCholesky::solve(std::vector<CoarseVector>& b) const {
  const auto columns = inverse_.size();
  for (std::size_t j = 0; j < columns; ++j) {
    for (auto e = uz(start_[j]); e < uz(start_[j + 1]); ++e) {
      b[uz(row_[e])].noalias() -= below_[e] * b[j];
    }
  }
  for (std::size_t j = columns; j-- > 0;) {
    CoarseVector x = inverse_[j] * b[j];
    for (auto e = uz(start_[j]); e < uz(start_[j + 1]); ++e) {
      x.noalias() -= below_[e].transpose() * b[uz(row_[e])];
    }
    b[j] = x;
  }
}

}  // namespace sinew
