#include "sinew/scene/framework_text.h"

#include <fmt/format.h>

#include <charconv>
#include <limits>

#include "sinew/io/text_reader.h"

namespace sinew {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\v' || c == '\f';
}

template <typename T>
std::optional<T> whole(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

}  // namespace

FrameworkWords::FrameworkWords(std::string_view text, std::string file, std::string_view layout)
    : file_(std::move(file)), layout_(layout) {
  std::size_t line_start = 0;
  int line = 1;
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] == '\n') {
      ++line;
      line_start = i + 1;
    }
    if (is_blank(text[i])) {
      ++i;
      continue;
    }
    const std::size_t begin = i;
    while (i < text.size() && !is_blank(text[i])) ++i;
    words_.push_back({text.substr(begin, i - begin), line,
                      static_cast<int>(std::min<std::size_t>(begin - line_start + 1,
                                                             std::numeric_limits<int>::max()))});
  }
  last_line_ = line;
}

std::size_t FrameworkWords::words_of_entry_line() const {
  std::size_t end = next_;
  while (end < words_.size() && words_[end].line == words_[next_].line) ++end;
  if (end < words_.size() && framework_number(words_[end].text)) return 0;
  return end - next_;
}

Location FrameworkWords::where() const {
  if (at_end()) return {file_, last_line_, 0};
  return {file_, words_[next_].line, words_[next_].column};
}

void FrameworkWords::refuse(const std::string& what, std::string_view kind) const {
  const std::string found = at_end() ? "the file ends" : "found " + io::quoted(words_[next_].text);
  throw Error(ErrorKind::input, fmt::format("expected {}{}, {}", what, kind, found),
              fmt::format("{} (docs/framework.md)", layout_), where());
}

std::string_view FrameworkWords::word(const std::string& what) {
  if (at_end()) refuse(what, "");
  return words_[next_++].text;
}

double FrameworkWords::number(const std::string& what) {
  const auto value = at_end() ? std::nullopt : framework_number(words_[next_].text);
  if (!value) refuse(what, " (a number)");
  ++next_;
  return *value;
}

std::int64_t FrameworkWords::integer(const std::string& what, std::int64_t low, std::int64_t high,
                                     const std::string& remedy) {
  const auto value = at_end() ? std::nullopt : whole<std::int64_t>(words_[next_].text);
  if (!value) refuse(what, " (a whole number)");
  if (*value < low || *value > high)
    throw Error(ErrorKind::input,
                fmt::format("{} is {}; expected {} to {}", what, *value, low, high), remedy,
                where());
  ++next_;
  return *value;
}

std::optional<double> framework_number(std::string_view word) {
  return whole<double>(word);
}

}  // namespace sinew
