// Tets grouped into rings around edges: a loop over a ring loads a node once for all its tets.
#pragma once

#include <span>
#include <vector>

#include "sinew/base/vec.h"

namespace sinew {

// A ring of tets around an edge, or a part of it; each tet shares a face with the next. Tet k has
// the corners axis[0], axis[1], nodes[k], nodes[k + 1], in positive order.
struct EdgeRing {
  Edge axis{};               // node ids, in any order
  std::vector<Index> nodes;  // node ids, one more than tets
  std::vector<Index> tets;   // ids

  std::size_t length() const { return tets.size(); }
  // Removes the last tet and returns it as a ring of its own. Requires two tets or more.
  EdgeRing split_last();
};

// Divides the chosen tets (ids into `tets`) into edge rings of at most `longest` tets, the longest
// first: greedy, edge by edge. Every tet is in one ring; the tets of a ring have equal keys.
std::vector<EdgeRing> cut_into_edge_rings(std::span<const Tet> tets, std::span<const Index> chosen,
                                          std::span<const int> key, std::size_t longest);

}  // namespace sinew
