#include "sinew/base/words.h"

#include <gtest/gtest.h>

#include <array>

namespace sinew {
namespace {

enum class Fruit { none, apple, pear };
constexpr std::array<Word<Fruit>, 2> words_of(Fruit) {
  return {{{Fruit::pear, "pear"}, {Fruit::apple, "apple"}}};
}

TEST(Words, LeadThereAndBack) {
  EXPECT_EQ(word_of(Fruit::apple), "apple");
  EXPECT_EQ(value_of<Fruit>("pear"), Fruit::pear);
  EXPECT_EQ(value_of<Fruit>("plum"), std::nullopt);
  EXPECT_EQ(word_of(Fruit::none), "");  // nothing that a user may write
}

TEST(Words, AreListedInTheOrderOfTheTable) {
  EXPECT_EQ(all_words<Fruit>(), "pear apple");
}

}  // namespace
}  // namespace sinew
