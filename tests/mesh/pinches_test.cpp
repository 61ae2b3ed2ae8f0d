#include "sinew/mesh/pinches.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace sinew {
namespace {

constexpr std::array<Triangle, 4> tet = {{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};

TEST(Pinches, NoneOnOneTet) {
  EXPECT_TRUE(non_manifold_edges(tet).empty());
  EXPECT_TRUE(non_manifold_nodes(tet).empty());
}

// A second tet that has these nodes instead of 0, 1, 2, 3.
std::vector<Triangle> with_a_second(const std::array<Index, 4>& nodes) {
  std::vector<Triangle> both(tet.begin(), tet.end());
  for (const Triangle& t : tet) both.push_back({nodes[uz(t[0])], nodes[uz(t[1])], nodes[uz(t[2])]});
  return both;
}

TEST(Pinches, TwoTetsThatShareAnEdge) {
  const auto both = with_a_second({3, 1, 4, 5});
  EXPECT_EQ(non_manifold_edges(both), std::vector<Edge>({{1, 3}}));
  EXPECT_EQ(non_manifold_nodes(both), std::vector<Index>());  // the two fans meet at the edge
}

TEST(Pinches, TwoTetsThatShareANode) {
  const auto both = with_a_second({2, 4, 5, 6});
  EXPECT_TRUE(non_manifold_edges(both).empty());
  EXPECT_EQ(non_manifold_nodes(both), std::vector<Index>({2}));
}

}  // namespace
}  // namespace sinew
