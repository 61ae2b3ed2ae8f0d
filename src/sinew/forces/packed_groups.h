// Puts rings, edge cells and one-rings into groups of sixteen, for packer.cpp.
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "sinew/base/vec.h"
#include "sinew/forces/packed_kernels.h"

namespace sinew {

// The springs of a node.
struct OneRing {
  Index centre = 0;
  std::vector<Index> springs;

  std::size_t length() const { return springs.size(); }
  OneRing split_last() {
    OneRing last{centre, {springs.back()}};
    springs.pop_back();
    return last;
  }
};

// Reorders the items so that neighbours in the list are far apart. An item that adds to the same
// node as the item before it has to wait for it.
template <class Item>
void spread(std::vector<Item>& items) {
  const std::size_t n = items.size();
  if (n < 3) return;
  std::size_t stride = std::max<std::size_t>(1, n * 5 / 8);
  while (std::gcd(stride, n) != 1) ++stride;
  std::vector<Item> out;
  for (std::size_t i = 0; i < n; ++i) out.push_back(std::move(items[i * stride % n]));
  items = std::move(out);
}

// Calls emit(length, items) with sixteen items of one length at a time. The remaining items of a
// length make a group of their own if they fill half of its lanes; otherwise they are split. The
// last call, with single ones, may get fewer.
template <class Item, class Emit>
void group_by_length(std::vector<Item> items, const Emit& emit) {
  constexpr auto lanes = uz(packed_lanes);
  std::size_t longest = 0;
  for (const Item& item : items) longest = std::max(longest, item.length());
  std::vector<Item> of_length;
  std::vector<Item> single;
  for (std::size_t length = longest; length > 0; --length) {
    for (Item& item : items) {
      if (item.length() == length) of_length.push_back(std::move(item));
    }
    std::erase_if(items, [](const Item& item) { return item.length() == 0; });
    if (length == 1) std::move(single.begin(), single.end(), std::back_inserter(of_length));
    spread(of_length);
    const std::size_t least = length == 1 ? 1 : lanes / 2;
    std::size_t first = 0;
    for (; first + least <= of_length.size(); first += lanes) {
      const std::size_t count = std::min(lanes, of_length.size() - first);
      emit(length, std::span<const Item>(of_length.data() + first, count));
    }
    of_length.erase(of_length.begin(), of_length.begin() + static_cast<std::ptrdiff_t>(
                                                               std::min(first, of_length.size())));
    for (Item& item : of_length) single.push_back(item.split_last());
  }
}

// The same for items that cannot be split: sixteen of falling size at a time; `size` is that of the
// first, the largest. A group has at most `most` items times their size.
template <class Size, class Emit>
void group_by_size(std::vector<Index> items, Index most, const Size& size_of, const Emit& emit) {
  std::stable_sort(items.begin(), items.end(),
                   [&](Index a, Index b) { return size_of(a) > size_of(b); });
  std::vector<Index> order;
  for (std::size_t begin = 0; begin < items.size();) {
    std::vector<Index> equal;
    const Index size = size_of(items[begin]);
    for (; begin < items.size() && size_of(items[begin]) == size; ++begin)
      equal.push_back(items[begin]);
    spread(equal);
    order.insert(order.end(), equal.begin(), equal.end());
  }
  for (std::size_t first = 0; first < order.size();) {
    const Index size = size_of(order[first]);
    const std::size_t count =
        std::min(uz(std::clamp(most / size, 1, packed_lanes)), order.size() - first);
    emit(size, std::span<const Index>(order.data() + first, count));
    first += count;
  }
}

// Appends sixteen values for each of `fields` fields, initially zero, and sets single values in
// them.
class Fields {
 public:
  Fields(std::vector<float>& data, Index fields) : data_(data), first_(data.size()) {
    data.resize(first_ + uz(fields * packed_lanes), 0.0f);
  }
  void put(Index field, std::size_t lane, double value) {
    data_[first_ + uz(field * packed_lanes) + lane] = static_cast<float>(value);
  }
  void put(Index field, std::size_t lane, const Vec3& value) {
    for (Index c = 0; c < 3; ++c) put(field + c, lane, value[c]);
  }

 private:
  std::vector<float>& data_;
  std::size_t first_;
};

}  // namespace sinew
