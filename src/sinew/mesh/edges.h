// The edges of a tetrahedral mesh, along which the springs lie.
#pragma once

#include <span>
#include <vector>

#include "sinew/base/vec.h"

namespace sinew {

// Unique edges in lexicographic order and the tets around each of them.
struct EdgeTable {
  std::vector<Edge> edges;       // node ids, the smaller first, sorted (edges)
  std::vector<Index> tet_start;  // the tets of edge e are tets[tet_start[e] .. tet_start[e+1])
                                 // (edges + 1)
  std::vector<Index> tets;       // tet ids, increasing for each edge (6 per tet)

  Index edge_count() const { return static_cast<Index>(edges.size()); }
  std::span<const Index> tets_of(Index edge) const {
    const std::size_t begin = uz(tet_start[uz(edge)]);
    return std::span<const Index>(tets).subspan(begin, uz(tet_start[uz(edge) + 1]) - begin);
  }
};

// Node ids must be in [0, node_count); otherwise Error(internal). Two equal corners of a degenerate
// tet make no edge. Time: linear in the number of tets.
EdgeTable build_edges(std::span<const Tet> tets, Index node_count);

}  // namespace sinew
