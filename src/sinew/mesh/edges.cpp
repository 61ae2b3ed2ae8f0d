#include "sinew/mesh/edges.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "sinew/base/cancel.h"
#include "sinew/base/error.h"

namespace sinew {
namespace {

constexpr std::array<std::array<int, 2>, 6> kTetEdges = {
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

// Calls f(low node, high node, tet) for every edge of every tet.
template <typename F>
void for_each_tet_edge(std::span<const Tet> tets, F&& f) {
  for (std::size_t t = 0; t < tets.size(); ++t) {
    for (const auto& [a, b] : kTetEdges) {
      const Index i = tets[t][static_cast<std::size_t>(a)];
      const Index j = tets[t][static_cast<std::size_t>(b)];
      if (i != j) f(std::min(i, j), std::max(i, j), static_cast<Index>(t));
    }
  }
}

}  // namespace

EdgeTable build_edges(std::span<const Tet> tets, Index node_count) {
  for (const Tet& tet : tets) {
    for (const Index i : tet) {
      if (i < 0 || i >= node_count)
        throw Error(ErrorKind::internal, "tet with a node out of range");
    }
  }

  // Counting sort by the lower node, then a small sort of (higher node, tet) at each node.
  std::vector<Index> start(uz(node_count) + 1, 0);
  for_each_tet_edge(tets, [&](Index low, Index, Index) { ++start[uz(low) + 1]; });
  for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];

  std::vector<std::uint64_t> keys(uz(start.back()));
  std::vector<Index> next(start.begin(), start.end() - 1);
  for_each_tet_edge(tets, [&](Index low, Index high, Index tet) {
    keys[uz(next[uz(low)]++)] =
        static_cast<std::uint64_t>(high) << 32 | static_cast<std::uint64_t>(tet);
  });

  EdgeTable table;
  table.tets.reserve(keys.size());
  for (Index low = 0; low < node_count; ++low) {
    stop_if_cancelled();
    const auto begin = keys.begin() + start[uz(low)];
    const auto end = keys.begin() + start[uz(low) + 1];
    std::sort(begin, end);
    for (auto key = begin; key != end; ++key) {
      if (key != begin && *key == *(key - 1)) continue;  // a degenerate tet names an edge twice
      if (key == begin || *key >> 32 != *(key - 1) >> 32) {
        table.edges.push_back({low, static_cast<Index>(*key >> 32)});
        table.tet_start.push_back(static_cast<Index>(table.tets.size()));
      }
      table.tets.push_back(static_cast<Index>(*key & 0xffffffffU));
    }
  }
  table.tet_start.push_back(static_cast<Index>(table.tets.size()));
  return table;
}

}  // namespace sinew
