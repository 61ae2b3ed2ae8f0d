// The tets near a cut, while edges are split and faces are opened.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sinew/base/vec.h"

namespace sinew {

// A new node at (1 - t) a + t b, where a and b are older nodes and t is in (0, 1).
struct EdgeSplit {
  Index a = -1, b = -1;
  double t = 0.5;  // [-]

  friend bool operator==(const EdgeSplit&, const EdgeSplit&) = default;
  template <typename T>
  T at(const std::vector<T>& values) const {
    return (1.0 - t) * values[uz(a)] + t * values[uz(b)];
  }
};

// A tet keeps its number in the patch when one of its edges is split; its other half comes last.
class Patch {
 public:
  // Of the tets with the numbers `ids`. New nodes are numbered from `node_count`.
  Patch(std::span<const Tet> tets, std::span<const Index> ids, Index node_count);

  std::span<const Tet> tets() const { return tet_; }
  Index parent(Index tet) const { return parent_[uz(tet)]; }  // number in the mesh before
  Index node_count() const { return node_count_; }            // of the mesh with the new nodes

  // The tets of the patch at the node; empty for nodes that are not in it.
  std::span<const Index> star(Index node) const;
  // Splits the edge and all tets of the patch around it. Returns the new node.
  Index split(Index a, Index b);

  // The other tet of the patch with the face opposite to `corner` of the tet; -1: none.
  Index neighbour(Index tet, Index corner) const;

 private:
  std::vector<Index>& list(Index node);
  Index find_neighbour(Index tet, Index corner) const;

  std::vector<Tet> tet_;
  std::vector<Index> parent_;
  Index node_count_ = 0;
  std::vector<Index> at_;                 // into star_, -1: not in the patch (nodes)
  std::vector<std::vector<Index>> star_;  // tets (nodes of the patch)
  // Neighbours that were asked for since the last split, -2: not yet (tets).
  mutable std::vector<std::array<Index, 4>> neighbour_;
};

// The face opposite to the corner, its nodes in rising order.
Triangle sorted_face(const Tet& tet, std::size_t corner);

}  // namespace sinew
