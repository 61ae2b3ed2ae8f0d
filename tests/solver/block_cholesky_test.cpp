#include "sinew/solver/block_cholesky.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace sinew {
namespace {

TEST(BlockCholesky, SolvesASparseSystemWithFillIn) {
  const int blocks = 5;
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(blocks * coarse_size, blocks * coarse_size);
  std::vector<std::map<Index, CoarseBlock>> column(blocks);
  for (int j = 0; j < blocks; ++j) {
    for (const int i : {j, j + 1, j + 3}) {
      if (i >= blocks) continue;
      CoarseBlock b = CoarseBlock::NullaryExpr([&] { return uniform(random); });
      if (i == j) b = CoarseBlock(0.5 * (b + b.transpose())) + 60.0 * CoarseBlock::Identity();
      column[static_cast<std::size_t>(j)][i] = b;
      a.block<coarse_size, coarse_size>(i * coarse_size, j * coarse_size) = b;
      a.block<coarse_size, coarse_size>(j * coarse_size, i * coarse_size) = b.transpose();
    }
  }
  std::vector<CoarseVector> x(blocks);
  Eigen::VectorXd b(blocks * coarse_size);
  for (int i = 0; i < blocks; ++i) {
    x[static_cast<std::size_t>(i)] =
        CoarseVector::NullaryExpr([&] { return static_cast<float>(uniform(random)); });
    b.segment<coarse_size>(i * coarse_size) = x[static_cast<std::size_t>(i)].cast<double>();
  }
  BlockCholesky(column).solve(x);
  Eigen::VectorXd solution(blocks * coarse_size);
  for (int i = 0; i < blocks; ++i) {
    solution.segment<coarse_size>(i * coarse_size) = x[static_cast<std::size_t>(i)].cast<double>();
  }
  EXPECT_LT((a * solution - b).norm(), 1e-5 * b.norm());
}

}  // namespace
}  // namespace sinew
