#include "sinew/mesh/node_sets.h"

#include <gtest/gtest.h>

namespace sinew {
namespace {

TEST(NodeSets, TheRootIsTheLowestNodeOfASet) {
  NodeSets sets(6);
  for (Index i = 0; i < 6; ++i) EXPECT_EQ(sets.root(i), i);
  sets.join(5, 3);
  sets.join(4, 5);
  sets.join(0, 0);
  EXPECT_EQ(sets.root(4), 3);
  EXPECT_EQ(sets.root(5), 3);
  sets.join(4, 1);
  for (const Index i : {1, 3, 4, 5}) EXPECT_EQ(sets.root(i), 1);
  EXPECT_EQ(sets.root(0), 0);
  EXPECT_EQ(sets.root(2), 2);
}

}  // namespace
}  // namespace sinew
