#include "sinew/contact/box_tree.h"

#include <algorithm>
#include <numeric>

namespace sinew {

BoxTree::BoxTree(std::span<const Vec3> centres, Index leaf_size) : leaf_size_(leaf_size) {
  item_.resize(centres.size());
  std::iota(item_.begin(), item_.end(), 0);
  if (item_.empty()) return;
  grow(centres, {0, static_cast<Index>(item_.size())});
  box_.resize(node_.size());
  item_box_.resize(item_.size());
}

// Splits the items in two across the longest side, until at most leaf_size_ are left.
Index BoxTree::grow(std::span<const Vec3> centres, Range items) {
  const auto self = static_cast<Index>(node_.size());
  node_.push_back({items, -1});
  if (items.size() <= leaf_size_) return self;
  Box box;
  for (Index i = items.begin; i < items.end; ++i) box.add(centres[uz(item_[uz(i)])]);
  Index axis = 0;
  (box.hi - box.lo).maxCoeff(&axis);
  const Index middle = items.begin + items.size() / 2;
  std::nth_element(item_.begin() + items.begin, item_.begin() + middle, item_.begin() + items.end,
                   [&](Index a, Index b) {
                     const double xa = centres[uz(a)][axis], xb = centres[uz(b)][axis];
                     return xa < xb || (xa == xb && a < b);
                   });
  grow(centres, {items.begin, middle});
  node_[uz(self)].right = grow(centres, {middle, items.end});
  return self;
}

std::vector<std::span<const Index>> BoxTree::leaves() const {
  std::vector<std::span<const Index>> all;
  for (const Node& node : node_) {
    if (node.right >= 0) continue;
    all.push_back(
        std::span<const Index>(item_).subspan(uz(node.items.begin), uz(node.items.size())));
  }
  return all;
}

void BoxTree::refit(std::span<const Box> boxes) {
  for (std::size_t i = 0; i < item_.size(); ++i) item_box_[i] = boxes[uz(item_[i])];
  for (std::size_t n = node_.size(); n-- > 0;) {  // children come after their parent
    Box b;
    if (node_[n].right < 0) {
      for (Index i = node_[n].items.begin; i < node_[n].items.end; ++i) b.add(item_box_[uz(i)]);
    } else {
      b = box_[n + 1];
      b.add(box_[uz(node_[n].right)]);
    }
    box_[n] = b;
  }
}

void BoxTree::find(const Box& box, std::vector<Index>& items) const {
  if (node_.empty()) return;
  std::array<Index, 64> stack;  // one entry per level; halving 2^31 items takes 29 levels
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const Index n = stack[--depth];
    if (!box_[uz(n)].overlaps(box)) continue;
    const Node& node = node_[uz(n)];
    if (node.right >= 0) {
      stack[depth++] = node.right;
      stack[depth++] = n + 1;
      continue;
    }
    for (Index i = node.items.begin; i < node.items.end; ++i) {
      if (item_box_[uz(i)].overlaps(box)) items.push_back(item_[uz(i)]);
    }
  }
}

}  // namespace sinew
