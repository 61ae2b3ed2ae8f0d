#include "sinew/mesh/coloring.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <set>

#include "sinew/base/error.h"
#include "sinew/mesh/edges.h"
#include "sinew/mesh/shapes.h"
#include "tests/mesh/made_meshes.h"

namespace sinew {
namespace {

// What the header promises, whatever the pairs.
bool is_valid(const Coloring& coloring, const std::vector<Edge>& pairs) {
  std::vector<Index> all = coloring.order;
  std::sort(all.begin(), all.end());
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    if (all.size() != pairs.size() || all[p] != static_cast<Index>(p)) return false;
  }
  for (Index c = 0; c < coloring.color_count(); ++c) {
    const auto ids = coloring.pairs_of(c);
    if (ids.empty() || !std::is_sorted(ids.begin(), ids.end())) return false;
    std::set<Index> nodes;
    for (const Index p : ids) {
      if (!nodes.insert(pairs[uz(p)][0]).second) return false;
      if (!nodes.insert(pairs[uz(p)][1]).second) return false;
    }
  }
  return true;
}

TEST(Coloring, Path) {
  const std::vector<Edge> pairs = {{0, 1}, {1, 2}, {2, 3}, {3, 4}};
  const Coloring coloring = color_pairs(pairs, 5);
  EXPECT_EQ(coloring.order, (std::vector<Index>{0, 2, 1, 3}));
  EXPECT_EQ(coloring.start, (std::vector<Index>{0, 2, 4}));
}

TEST(Coloring, NoPairs) {
  const Coloring coloring = color_pairs({}, 3);
  EXPECT_EQ(coloring.color_count(), 0);
  EXPECT_TRUE(coloring.order.empty());
}

TEST(Coloring, StarNeedsAColorForEveryPairAndEndsSoon) {
  std::vector<Edge> pairs;
  for (Index i = 1; i <= 100'000; ++i) pairs.push_back({0, i});
  const Coloring coloring = color_pairs(pairs, 100'001);
  EXPECT_EQ(coloring.color_count(), 100'000);
  EXPECT_TRUE(is_valid(coloring, pairs));
}

TEST(Coloring, NodeOutOfRangeIsRefused) {
  EXPECT_THROW(color_pairs(std::vector<Edge>{{0, 3}}, 3), Error);
  EXPECT_THROW(color_pairs(std::vector<Edge>{{-1, 2}}, 3), Error);
}

RC_GTEST_PROP(Coloring, NoTwoPairsOfAColorShareANode, ()) {
  const TetMesh mesh = testing::random_mesh();
  const std::vector<Edge> pairs = build_edges(mesh.tets, mesh.node_count()).edges;
  RC_ASSERT(is_valid(color_pairs(pairs, mesh.node_count()), pairs));
}

RC_GTEST_PROP(Coloring, HoldsForAnyPairs, ()) {
  const Index nodes = *rc::gen::inRange(2, 40);
  const auto pairs = *rc::gen::container<std::vector<Edge>>(
      rc::gen::map(rc::gen::pair(rc::gen::inRange(0, nodes), rc::gen::inRange(1, nodes)),
                   [=](const std::pair<Index, Index>& p) {
                     return Edge{p.first, (p.first + p.second) % nodes};
                   }));
  const Coloring coloring = color_pairs(pairs, nodes);
  RC_ASSERT(is_valid(coloring, pairs));
  std::vector<Index> degree(uz(nodes), 0);
  for (const Edge& pair : pairs) {
    for (const Index i : pair) ++degree[uz(i)];
  }
  const Index most = *std::max_element(degree.begin(), degree.end());
  RC_ASSERT(coloring.color_count() <= std::max(0, 2 * most - 1));
}

TEST(Coloring, OfTheBenchmarkBeamHasFewColors) {
  const TetMesh mesh = beam({0.1, 0.1, 0.4}, {8, 8, 32});
  const std::vector<Edge> pairs = build_edges(mesh.tets, mesh.node_count()).edges;
  const Coloring coloring = color_pairs(pairs, mesh.node_count());
  EXPECT_TRUE(is_valid(coloring, pairs));
  EXPECT_EQ(coloring.color_count(), 18);  // 18 edges meet at an inner node
}

}  // namespace
}  // namespace sinew
