#include "sinew/mesh/edge_rings.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace sinew {
namespace {

// The six edges of a tet, each with the other two corners so that all four are in positive order.
constexpr std::array<std::array<std::size_t, 4>, 6> edge_views = {
    {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}}};

// A tet seen from one of its edges, whose smaller node comes first.
struct View {
  std::uint64_t axis;  // the smaller node above the larger one: ordered as the edges are
  Index from, to;      // the ring's nodes: the axis' nodes, from, to are in positive order
  Index tet;           // place in `chosen`

  Edge edge() const {
    return {static_cast<Index>(axis >> 32), static_cast<Index>(axis & 0xffffffffU)};
  }
};

std::uint64_t axis_of(Index low, Index high) {
  return static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint64_t>(high);
}

std::vector<View> views_of(std::span<const Tet> tets, std::span<const Index> chosen) {
  std::vector<View> views;
  views.reserve(6 * chosen.size());
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const Tet& t = tets[uz(chosen[k])];
    for (const auto& [a, b, c, d] : edge_views) {
      if (t[a] < t[b]) {
        views.push_back({axis_of(t[a], t[b]), t[c], t[d], static_cast<Index>(k)});
      } else {
        views.push_back({axis_of(t[b], t[a]), t[d], t[c], static_cast<Index>(k)});
      }
    }
  }
  std::sort(views.begin(), views.end(), [](const View& p, const View& q) {
    return p.axis != q.axis ? p.axis < q.axis : p.tet < q.tet;
  });
  return views;
}

// The longest chain of free views around one edge, as places in `star`; at most `longest` of them.
class Chains {
 public:
  Chains(std::span<const View> star, std::span<const Index> chosen, std::span<const int> key,
         const std::vector<char>& taken)
      : star_(star), chosen_(chosen), key_(key), taken_(taken) {}

  std::vector<std::size_t> find(std::size_t longest) const {
    std::vector<std::size_t> best;
    for (std::size_t first = 0; first < star_.size(); ++first) {
      if (taken_[uz(star_[first].tet)] != 0) continue;
      std::vector<std::size_t> chain{first};
      while (chain.size() < longest) {
        const std::size_t next = after(chain.back());
        if (next == star_.size() || next == first) break;
        chain.push_back(next);
      }
      if (chain.size() > best.size()) best = std::move(chain);
      if (best.size() == longest) break;
    }
    return best;
  }

 private:
  std::size_t after(std::size_t k) const {
    const auto key_of = [&](const View& v) { return key_[uz(chosen_[uz(v.tet)])]; };
    std::size_t n = 0;
    while (n < star_.size() && (star_[n].from != star_[k].to || taken_[uz(star_[n].tet)] != 0 ||
                                key_of(star_[n]) != key_of(star_[k]))) {
      ++n;
    }
    return n;
  }

  std::span<const View> star_;
  std::span<const Index> chosen_;
  std::span<const int> key_;
  const std::vector<char>& taken_;
};

}  // namespace

EdgeRing EdgeRing::split_last() {
  EdgeRing last{axis, {nodes[nodes.size() - 2], nodes.back()}, {tets.back()}};
  nodes.pop_back();
  tets.pop_back();
  return last;
}

std::vector<EdgeRing> cut_into_edge_rings(std::span<const Tet> tets, std::span<const Index> chosen,
                                          std::span<const int> key, std::size_t longest) {
  const std::vector<View> views = views_of(tets, chosen);
  std::vector<std::span<const View>> stars;  // those that may still give a ring
  for (std::size_t begin = 0; begin < views.size();) {
    std::size_t end = begin;
    while (end < views.size() && views[end].axis == views[begin].axis) ++end;
    stars.emplace_back(views.data() + begin, end - begin);
    begin = end;
  }
  std::vector<char> taken(chosen.size(), 0);
  std::vector<EdgeRing> rings;
  for (std::size_t length = longest; length > 0; --length) {
    std::vector<std::span<const View>> left;
    for (const auto& star : stars) {
      std::vector<std::size_t> chain = Chains(star, chosen, key, taken).find(length);
      for (; chain.size() == length; chain = Chains(star, chosen, key, taken).find(length)) {
        EdgeRing ring{star.front().edge(), {star[chain.front()].from}, {}};
        for (const std::size_t k : chain) {
          taken[uz(star[k].tet)] = 1;
          ring.nodes.push_back(star[k].to);
          ring.tets.push_back(chosen[uz(star[k].tet)]);
        }
        rings.push_back(std::move(ring));
      }
      if (!chain.empty()) left.push_back(star);
    }
    stars = std::move(left);
  }
  return rings;
}

}  // namespace sinew
