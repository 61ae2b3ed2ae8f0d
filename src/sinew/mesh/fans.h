// Tets as fans around edges: loops over tets that load a node once where neighbours share it.
#pragma once

#include <span>
#include <vector>

#include "sinew/base/vec.h"

namespace sinew {

// Tets around an edge, each sharing a face with the next: tet k has the corners axis[0], axis[1],
// ring[k], ring[k + 1], in positive order.
struct Fan {
  Edge axis{};              // node ids, in any order
  std::vector<Index> ring;  // node ids, one more than tets
  std::vector<Index> tets;  // ids

  std::size_t length() const { return tets.size(); }
  // Takes the last tet off, as a fan of its own. Needs two tets or more.
  Fan split_last();
};

// Cuts the chosen tets (ids into `tets`) into fans of at most `longest`, the longest first: greedy,
// edge by edge. Every tet is in one fan; the tets of a fan have equal keys.
std::vector<Fan> cut_into_fans(std::span<const Tet> tets, std::span<const Index> chosen,
                               std::span<const int> key, std::size_t longest);

}  // namespace sinew
