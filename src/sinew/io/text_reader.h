// A tokeniser over a whole file in memory: words and numbers separated by blanks, each with its
// line and column. Every reader of this room uses it, so all their errors name the place, the
// expected value, the value found, and the remedy.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "sinew/base/error.h"

namespace sinew::io {

// The separators of words: space, and tab to carriage return.
constexpr bool is_blank(char c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}

// The remedy for a file that ends too early.
inline constexpr const char* cut_short = "the file was cut short: fetch or export it again";

// The next expected value, for errors: "x of vertex 12", "the number of vertices". A plain value
// that becomes text only in an error.
struct Wanted {
  std::string_view value;    // "x"
  std::string_view of = {};  // "vertex"
  std::int64_t number = -1;  // which of them; negative: not numbered
};

class TextReader {
 public:
  // text must outlive the reader. comment: the character that starts a comment up to the end of
  // its line, 0 for none.
  TextReader(std::string_view text, std::string file, char comment);

  // The current part of the file, for errors: a name ("section Vertices") and the form of one entry
  // ("x y z label"). Both must be literals or outlive the reader.
  void set_part(std::string_view part, std::string_view layout);

  bool at_end();            // only blanks and comments are left
  bool at_line_end();       // no value is left on this line
  std::string_view peek();  // the next word, not consumed; empty at the end

  // The next value, or an Error. `real` accepts every double of std::from_chars, nan and inf
  // included (the mesh doctor refuses those, with the node's number).
  std::string_view word(const Wanted& wanted);
  double real(const Wanted& wanted);
  std::int64_t integer(const Wanted& wanted);
  std::int64_t integer(const Wanted& wanted, std::int64_t low, std::int64_t high);
  int label(const Wanted& wanted);  // any 32-bit whole number
  // A number of records that must fit in the rest of the text, each of at least so many values
  // (a value and its blank take two characters). Checked here, before anything is allocated.
  std::size_t count(const Wanted& wanted, std::size_t values_per_record);

  void skip_values(std::size_t count, const Wanted& wanted);
  std::string_view line_rest();  // up to the line break, which is consumed

  // Raw bytes. After `end_line`, which consumes one line break, a binary block starts.
  void end_line(const Wanted& wanted);
  std::string_view take(std::size_t bytes, const Wanted& wanted);
  std::size_t offset() const { return static_cast<std::size_t>(at_ - text_.data()); }
  std::size_t remaining() const { return static_cast<std::size_t>(end_ - at_); }
  // Moves to the next occurrence of `what`, starting here; false if there is none.
  bool find(std::string_view what);
  // Moves forward to a place; errors point there until a value is read.
  void go_to(std::size_t place);
  // A file with binary blocks has no meaningful lines: errors name the byte instead.
  void set_binary() { binary_ = true; }
  bool binary() const { return binary_; }

  const std::string& file() const { return file_; }

  // Errors that point at the last value read.
  [[noreturn]] void fail(std::string message, std::string remedy) const;
  // An error of the whole file: a missing part.
  [[noreturn]] void fail_file(std::string message, std::string remedy) const;
  // "expected WANTED (a whole number), found "abc"".
  [[noreturn]] void fail_expected(const Wanted& wanted, std::string_view kind,
                                  std::string_view found) const;

 private:
  void skip_blanks();
  bool ends_word(const char* p) const;
  void start_value(const Wanted& wanted);
  std::string_view rest_of_word() const;
  [[noreturn]] void fail_end(const Wanted& wanted) const;

  std::string_view text_;
  std::string file_;
  char comment_;
  bool binary_ = false;
  const char* at_;  // next character
  const char* end_;
  const char* line_start_;  // first character of the line of at_
  int line_;
  const char* value_ = nullptr;  // the last value, for errors
  const char* value_line_start_ = nullptr;
  int value_line_ = 0;
  std::string_view part_;
  std::string_view layout_;
};

// "x of vertex 12".
std::string to_text(const Wanted& wanted);
// A word of a file, quoted for a message: non-printing bytes become \xNN, long words are truncated.
std::string quoted(std::string_view word);

}  // namespace sinew::io
