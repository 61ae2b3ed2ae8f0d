// The words of an enum, in one table that the parser, the messages and JSON share.
//
// An enum E has words where its own namespace has a function
//   constexpr std::array<Word<E>, N> words_of(E)
// whose argument only selects the table. Values without a word cannot be written by a user.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace sinew {

template <typename E>
struct Word {
  E value;
  std::string_view word;
};

// The word of a value; empty if it has none.
template <typename E>
constexpr std::string_view word_of(E value) {
  for (const auto& [known, word] : words_of(E{}))
    if (known == value) return word;
  return {};
}

// The value of a word.
template <typename E>
constexpr std::optional<E> value_of(std::string_view word) {
  for (const auto& [value, known] : words_of(E{}))
    if (known == word) return value;
  return std::nullopt;
}

// All words in the table's order, separated by spaces. Lives as long as the program.
template <typename E>
std::string_view all_words() {
  static const std::string words = [] {
    std::string list;
    for (const auto& entry : words_of(E{})) {
      if (!list.empty()) list += ' ';
      list += entry.word;
    }
    return list;
  }();
  return words;
}

}  // namespace sinew
