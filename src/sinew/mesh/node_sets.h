// Which nodes are joined, directly or through others.
#pragma once

#include <numeric>
#include <vector>

#include "sinew/base/vec.h"

namespace sinew {

// Disjoint sets of nodes: union-find with path halving. The root of a set is its lowest node.
class NodeSets {
 public:
  explicit NodeSets(Index count) : parent_(uz(count)) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  Index root(Index i) {
    while (parent_[uz(i)] != i) {
      parent_[uz(i)] = parent_[uz(parent_[uz(i)])];
      i = parent_[uz(i)];
    }
    return i;
  }
  void join(Index i, Index j) {
    i = root(i);
    j = root(j);
    if (i < j) parent_[uz(j)] = i;
    if (j < i) parent_[uz(i)] = j;
  }

 private:
  std::vector<Index> parent_;
};

}  // namespace sinew
