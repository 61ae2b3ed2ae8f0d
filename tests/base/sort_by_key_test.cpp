#include "sinew/base/sort_by_key.h"

#include <gtest/gtest.h>

namespace sinew {
namespace {

TEST(SortByKey, ListsItemsByKeyInIncreasingOrder) {
  const std::vector<int> key = {2, 0, -1, 2, 0, 3};
  std::vector<Index> start, items;
  sort_by_key(
      4, static_cast<Index>(key.size()), [&](Index i) { return key[uz(i)]; }, start, items);
  EXPECT_EQ(start, (std::vector<Index>{0, 2, 2, 4, 5}));
  EXPECT_EQ(items, (std::vector<Index>{1, 4, 0, 3, 5}));  // item 2 has a negative key
}

TEST(SortByKey, NothingGivesEmptyLists) {
  std::vector<Index> start = {7}, items = {7};
  sort_by_key(
      2, 0, [](Index) { return 0; }, start, items);
  EXPECT_EQ(start, (std::vector<Index>{0, 0, 0}));
  EXPECT_TRUE(items.empty());
}

}  // namespace
}  // namespace sinew
