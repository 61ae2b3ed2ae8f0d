// Boxes in a structure of arrays, to compare one with many (SIMD).
#pragma once

#include <array>
#include <vector>

#include "sinew/contact/box_tree.h"

namespace sinew {

class Boxes {
 public:
  Index count() const { return count_; }
  void clear() { count_ = 0; }

  // Rounded outwards to single precision; `item`: what it is the box of.
  void add(const Box& box, Index item);

  // Those of `other` that overlap `box`, from the lowest to the highest of their places shifted by
  // 0 and by `way`, and larger by `off` [m] all around.
  void add_overlapping(const Boxes& other, const Box& box, const Vec3& way, double off);

  // The items whose boxes overlap `box`, in their order.
  void find(const Box& box, std::vector<Index>& items) const;

  // How far each is from `box` at least, < 0 where they overlap [m] (boxes).
  void gaps_to(const Box& box, std::vector<float>& gaps) const;

 private:
  void make_room(Index more);

  // lo x, y, z, hi x, y, z [m] and the items; longer than count_ by the longest vector, which
  // kernels may fill.
  std::array<std::vector<float>, 6> side_;
  std::vector<Index> item_;
  Index count_ = 0;
};

}  // namespace sinew
