#include "sinew/mesh/coloring.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <numeric>

#include "sinew/base/error.h"

namespace sinew {
namespace {

// The colours taken at one node, as bits of 64-bit words.
class UsedColors {
 public:
  std::uint64_t word(std::size_t w) const { return w < words_.size() ? words_[w] : 0; }
  std::size_t first_open_word() const { return first_open_; }
  void take(Index color) {
    const std::size_t w = uz(color) / 64;
    if (w >= words_.size()) words_.resize(w + 1, 0);
    words_[w] |= std::uint64_t{1} << (uz(color) % 64);
    while (word(first_open_) == ~std::uint64_t{0}) ++first_open_;
  }

 private:
  std::vector<std::uint64_t> words_;
  std::size_t first_open_ = 0;  // every word before it is full
};

Index lowest_free(const UsedColors& a, const UsedColors& b) {
  for (std::size_t w = std::max(a.first_open_word(), b.first_open_word());; ++w) {
    const int bit = std::countr_one(a.word(w) | b.word(w));
    if (bit < 64) return static_cast<Index>(64 * w) + bit;
  }
}

}  // namespace

Coloring color_pairs(std::span<const Edge> pairs, Index node_count) {
  for (const Edge& pair : pairs) {
    if (std::min(pair[0], pair[1]) < 0 || std::max(pair[0], pair[1]) >= node_count) {
      throw Error(ErrorKind::internal, "pair with a node out of range");
    }
  }

  std::vector<UsedColors> used(uz(node_count));
  std::vector<Index> color(pairs.size());
  Index color_count = 0;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    UsedColors& at_first = used[uz(pairs[p][0])];
    UsedColors& at_second = used[uz(pairs[p][1])];
    color[p] = lowest_free(at_first, at_second);
    at_first.take(color[p]);
    at_second.take(color[p]);
    color_count = std::max(color_count, color[p] + 1);
  }

  Coloring result;
  result.start.assign(uz(color_count) + 1, 0);
  for (const Index c : color) ++result.start[uz(c) + 1];
  std::partial_sum(result.start.begin(), result.start.end(), result.start.begin());
  result.order.resize(pairs.size());
  std::vector<Index> next(result.start.begin(), result.start.end() - 1);
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    result.order[uz(next[uz(color[p])]++)] = static_cast<Index>(p);
  }
  return result;
}

}  // namespace sinew
