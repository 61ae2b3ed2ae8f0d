// The words of a file of the course framework, in order, with their places.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/base/error.h"

namespace sinew {

struct FrameworkWord {
  std::string_view text;
  int line = 0;    // from 1
  int column = 0;  // from 1
};

class FrameworkWords {
 public:
  // The text must outlive this object. `layout`: the form of one entry, for messages.
  FrameworkWords(std::string_view text, std::string file, std::string_view layout);

  bool at_end() const { return next_ == words_.size(); }
  std::size_t left() const { return words_.size() - next_; }
  // Remaining words on the line of the next one; 0 at the end, and if the entry may continue on the
  // line below, which begins with a number.
  std::size_t words_of_entry_line() const;
  // The place of the next word; after the last word, the end of the text.
  Location where() const;

  // Each reads a word; `what` names the expected value: "qx of object 3". Error (input) if the word
  // is missing or different.
  std::string_view word(const std::string& what);
  double number(const std::string& what);
  std::int64_t integer(const std::string& what, std::int64_t low, std::int64_t high,
                       const std::string& remedy);

 private:
  [[noreturn]] void refuse(const std::string& what, std::string_view kind) const;

  std::string file_;
  std::string_view layout_;
  std::vector<FrameworkWord> words_;
  std::size_t next_ = 0;
  int last_line_ = 1;
};

// The number of a whole word, in the form of C++ streams: with or without a sign.
std::optional<double> framework_number(std::string_view word);

}  // namespace sinew
