// Colours for pairs of nodes. Pairs of one colour share no node, so they can be processed in
// parallel, and the result does not depend on the number of threads.
#pragma once

#include <span>
#include <vector>

#include "sinew/base/vec.h"

namespace sinew {

struct Coloring {
  std::vector<Index> order;  // pair ids, grouped by colour, increasing within a colour (pairs)
  std::vector<Index>
      start;  // the pairs of colour c are order[start[c] .. start[c+1]) (colours + 1)

  Index color_count() const { return static_cast<Index>(start.size()) - 1; }
  std::span<const Index> pairs_of(Index color) const {
    const std::size_t begin = uz(start[uz(color)]);
    return std::span<const Index>(order).subspan(begin, uz(start[uz(color) + 1]) - begin);
  }
};

// Greedy: each pair in turn takes the lowest colour that is free at both its nodes. At most
// 2 * (largest number of pairs at a node) - 1 colours. Node ids must be in [0, node_count);
// otherwise Error(internal).
Coloring color_pairs(std::span<const Edge> pairs, Index node_count);

}  // namespace sinew
