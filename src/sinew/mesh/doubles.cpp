#include "sinew/mesh/doubles.h"

#include <algorithm>
#include <array>
#include <tuple>

namespace sinew {
namespace {

using Pairs = std::vector<std::pair<Index, Index>>;

std::vector<Index> used_nodes(std::span<const Vec3> nodes, std::span<const Tet> tets) {
  std::vector<char> used(nodes.size(), 0);
  for (const Tet& t : tets)
    for (const Index i : t) used[uz(i)] = 1;
  std::vector<Index> list;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (used[i] != 0) list.push_back(static_cast<Index>(i));
  return list;
}

// Adds pairs of equal positions; `list` keeps the first of each.
void take_equal(std::span<const Vec3> nodes, std::vector<Index>& list, Pairs& pairs) {
  const auto position = [&](Index i) {
    const Vec3& x = nodes[uz(i)];
    return std::array<double, 3>{x.x(), x.y(), x.z()};
  };
  std::stable_sort(list.begin(), list.end(),
                   [&](Index i, Index j) { return position(i) < position(j); });
  std::size_t kept = 0;
  for (const Index i : list) {
    if (kept > 0 && position(list[kept - 1]) == position(i)) {
      pairs.emplace_back(i, list[kept - 1]);
    } else {
      list[kept++] = i;
    }
  }
  list.resize(kept);
}

// The nearest pairs along a direction in which the planes of a structured mesh do not coincide.
Pairs near_pairs(std::span<const Vec3> nodes, std::vector<Index> list, double distance) {
  const Vec3 direction = Vec3(0.5413, 0.7253, 0.4257).normalized();
  std::vector<std::pair<double, Index>> along;
  for (const Index i : list) along.emplace_back(direction.dot(nodes[uz(i)]), i);
  std::sort(along.begin(), along.end());
  Pairs pairs;
  for (std::size_t k = 1; k < along.size(); ++k) {
    for (std::size_t j = k; j > 0 && along[k].first - along[j - 1].first <= distance; --j) {
      const Index a = along[k].second, b = along[j - 1].second;
      if ((nodes[uz(a)] - nodes[uz(b)]).norm() > distance) continue;
      pairs.emplace_back(std::max(a, b), std::min(a, b));
      break;
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

// Removes the pairs that are an edge of a tet: a short edge is no double node.
void remove_edges(std::span<const Tet> tets, Pairs& pairs) {
  if (pairs.empty()) return;
  std::vector<char> is_edge(pairs.size(), 0);
  for (const Tet& t : tets) {
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < 4; ++b) {
        if (t[a] <= t[b]) continue;
        const auto at = std::lower_bound(pairs.begin(), pairs.end(), std::pair(t[a], t[b]));
        if (at != pairs.end() && *at == std::pair(t[a], t[b]))
          is_edge[static_cast<std::size_t>(at - pairs.begin())] = 1;
      }
    }
  }
  std::size_t kept = 0;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (is_edge[k] == 0) pairs[kept++] = pairs[k];
  pairs.resize(kept);
}

}  // namespace

std::vector<std::pair<Index, Index>> find_doubles(std::span<const Vec3> nodes,
                                                  std::span<const Tet> tets) {
  Pairs pairs;
  std::vector<Index> list = used_nodes(nodes, tets);
  if (list.empty()) return pairs;
  Vec3 low = nodes[uz(list.front())], high = low;
  for (const Index i : list) {
    low = low.cwiseMin(nodes[uz(i)]);
    high = high.cwiseMax(nodes[uz(i)]);
  }
  take_equal(nodes, list, pairs);
  Pairs close = near_pairs(nodes, std::move(list), kDouble * (high - low).norm());
  remove_edges(tets, close);
  pairs.insert(pairs.end(), close.begin(), close.end());
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace sinew
