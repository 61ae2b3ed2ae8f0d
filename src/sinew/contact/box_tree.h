// A tree of bounding boxes: finds the boxes of a set that overlap a given one. The tree is built
// once; its boxes follow the items as they move.
#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include "sinew/base/vec.h"

namespace sinew {

// An axis-aligned box [m]; empty until something is added.
struct Box {
  Vec3 lo = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 hi = Vec3::Constant(-std::numeric_limits<double>::infinity());

  void add(const Vec3& x) {
    lo = lo.cwiseMin(x);
    hi = hi.cwiseMax(x);
  }
  void add(const Box& b) {
    lo = lo.cwiseMin(b.lo);
    hi = hi.cwiseMax(b.hi);
  }
  Box grown(double by) const {
    Box b = *this;
    b.lo.array() -= by;
    b.hi.array() += by;
    return b;
  }
  bool overlaps(const Box& b) const {
    return (lo.array() <= b.hi.array()).all() && (b.lo.array() <= hi.array()).all();
  }
};

// The box around the nodes at positions x [m] (nodes of the model).
template <std::size_t n>
Box box_around(const std::array<Index, n>& nodes, const std::vector<Vec3>& x) {
  Box box;
  for (const Index i : nodes) box.add(x[uz(i)]);
  return box;
}

class BoxTree {
 public:
  // Builds the tree from the centres of the items: items near each other share a branch. A leaf
  // holds at most `leaf_size` items.
  explicit BoxTree(std::span<const Vec3> centres, Index leaf_size = 4);
  BoxTree() = default;

  // Sets the current boxes of the items (items).
  void refit(std::span<const Box> boxes);

  // The box around all items.
  const Box& bounds() const { return box_[0]; }
  bool empty() const { return item_.empty(); }

  // The items of each leaf.
  std::vector<std::span<const Index>> leaves() const;

  // Appends the items whose boxes overlap `box`, in the tree's order.
  void find(const Box& box, std::vector<Index>& items) const;

 private:
  struct Node {
    Range items;       // of item_
    Index right = -1;  // the left child comes next; -1: a leaf
  };
  Index grow(std::span<const Vec3> centres, Range items);

  Index leaf_size_ = 4;
  std::vector<Node> node_;
  std::vector<Box> box_;       // (nodes of the tree)
  std::vector<Index> item_;    // items, in the order of the leaves
  std::vector<Box> item_box_;  // in the order of item_
};

}  // namespace sinew
