// Boxes as a structure of arrays: one box is compared with many (SIMD).
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "sinew/contact/box_tree.h"

namespace sinew {

// Single-precision bounds of a value, on either side of it.
inline float rounded_down(double x) {
  return static_cast<float>(x - 1e-6 * std::abs(x));
}
inline float rounded_up(double x) {
  return static_cast<float>(x + 1e-6 * std::abs(x));
}

class Boxes {
 public:
  Index count() const { return count_; }
  void clear() { count_ = 0; }

  // Adds the box of `item`, rounded outwards to single precision.
  void add(const Box& box, Index item);

  // Adds the boxes of `other` that overlap `box`. Each added box covers its displacements from 0 to
  // `displacement` and is larger by `margin` [m] on all sides.
  void add_overlapping(const Boxes& other, const Box& box, const Vec3& displacement, double margin);

  // The items whose boxes overlap `box`, in their order.
  void find(const Box& box, std::vector<Index>& items) const;

  // The lower bound of the distance of each box from `box` [m] (boxes); < 0: they overlap.
  void gaps_to(const Box& box, std::vector<float>& gaps) const;

 private:
  void make_room(Index more);

  // lo x, y, z, hi x, y, z [m] and the items. The arrays are longer than count_ by the length of
  // the longest vector, because the kernels write whole vectors.
  std::array<std::vector<float>, 6> side_;
  std::vector<Index> item_;
  Index count_ = 0;
};

}  // namespace sinew
