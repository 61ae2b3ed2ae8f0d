// Lists of items by key, in two flat arrays.
#pragma once

#include <cstddef>
#include <vector>

#include "sinew/base/vec.h"

namespace sinew {

// items[start[k] .. start[k + 1]) = the i in [0, count) with key(i) = k, in increasing order; those
// with a negative key are left out.
template <typename Key>
void sort_by_key(std::size_t keys, Index count, const Key& key, std::vector<Index>& start,
                 std::vector<Index>& items) {
  start.assign(keys + 1, 0);
  for (Index i = 0; i < count; ++i) {
    if (key(i) >= 0) ++start[uz(key(i)) + 1];
  }
  for (std::size_t k = 1; k < start.size(); ++k) start[k] += start[k - 1];
  items.resize(uz(start.back()));
  std::vector<Index> next(start.begin(), start.end() - 1);
  for (Index i = 0; i < count; ++i) {
    if (key(i) >= 0) items[uz(next[uz(key(i))]++)] = i;
  }
}

}  // namespace sinew
