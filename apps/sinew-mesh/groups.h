// SPDX-License-Identifier: GPL-3.0-or-later
// Small helpers for the examination of surfaces.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "sinew/base/vec.h"

namespace sinew::mesher {

// Union-find; the smallest member identifies a group.
class Groups {
 public:
  explicit Groups(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  Index of(Index i) {
    while (parent_[uz(i)] != i) i = parent_[uz(i)] = parent_[uz(parent_[uz(i)])];
    return i;
  }
  void join(Index i, Index j) { parent_[uz(std::max(of(i), of(j)))] = std::min(of(i), of(j)); }

 private:
  std::vector<Index> parent_;
};

// "1 hole", "2 holes"
inline std::string counted(std::int64_t n, const char* what) {
  return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s");
}

}  // namespace sinew::mesher
