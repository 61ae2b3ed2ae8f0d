#include "sinew/io/text_reader.h"

#include "sinew/base/cancel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstring>
#include <limits>
#include <utility>

namespace sinew::io {
namespace {

constexpr std::string_view cut_short_remedy =
    "the file was cut short or its count is too large: fetch it again, or correct the count";

int column_of(const char* place, const char* line_start) {
  return static_cast<int>(
      std::min<std::ptrdiff_t>(place - line_start + 1, std::numeric_limits<int>::max()));
}

}  // namespace

TextReader::TextReader(std::string_view text, std::string file, char comment)
    : text_(text),
      file_(std::move(file)),
      comment_(comment),
      at_(text.data()),
      end_(text.data() + text.size()),
      line_start_(at_),
      line_(1) {
  constexpr std::string_view utf8_mark = "\xEF\xBB\xBF";
  if (text.starts_with(utf8_mark)) at_ += utf8_mark.size();
}

void TextReader::set_part(std::string_view part, std::string_view layout) {
  part_ = part;
  layout_ = layout;
}

void TextReader::skip_blanks() {
  for (; at_ != end_; ++at_) {
    if (*at_ == '\n') {
      ++line_;
      line_start_ = at_ + 1;
    } else if (comment_ != 0 && *at_ == comment_) {
      const void* stop = std::memchr(at_, '\n', remaining());
      if (stop == nullptr) {
        at_ = end_;
        return;
      }
      at_ = static_cast<const char*>(stop) - 1;
    } else if (!is_blank(*at_)) {
      return;
    }
  }
}

bool TextReader::ends_word(const char* p) const {
  return p == end_ || is_blank(*p) || (comment_ != 0 && *p == comment_);
}

std::string_view TextReader::rest_of_word() const {
  const char* stop = at_;
  while (!ends_word(stop)) ++stop;
  return {at_, static_cast<std::size_t>(stop - at_)};
}

bool TextReader::at_end() {
  skip_blanks();
  return at_ == end_;
}

bool TextReader::at_line_end() {
  while (at_ != end_ && *at_ != '\n' && is_blank(*at_)) ++at_;
  return at_ == end_ || *at_ == '\n' || (comment_ != 0 && *at_ == comment_);
}

std::string_view TextReader::peek() {
  skip_blanks();
  return rest_of_word();
}

void TextReader::start_value(const Wanted& wanted) {
  stop_if_cancelled();
  skip_blanks();
  value_ = at_;
  value_line_ = line_;
  value_line_start_ = line_start_;
  if (at_ == end_) fail_end(wanted);
}

std::string_view TextReader::word(const Wanted& wanted) {
  start_value(wanted);
  const std::string_view found = rest_of_word();
  at_ += found.size();
  return found;
}

double TextReader::real(const Wanted& wanted) {
  start_value(wanted);
  const char* first = *at_ == '+' && end_ - at_ > 1 && at_[1] != '-' ? at_ + 1 : at_;
  double value = 0;
  const auto [stop, code] = std::from_chars(first, end_, value);
  if (code == std::errc::invalid_argument || !ends_word(stop)) {
    fail_expected(wanted, "a number", rest_of_word());
  }
  if (code == std::errc::result_out_of_range) {
    // A number that is too small becomes zero; one that is too large is an error.
    const std::string_view found = rest_of_word();
    if (found.find("e-") == found.npos && found.find("E-") == found.npos) {
      fail(fmt::format("{} is {}, larger than a double can hold (1.8e308)", to_text(wanted),
                       quoted(found)),
           "correct the number");
    }
    value = 0;
  }
  at_ = stop;
  return value;
}

std::int64_t TextReader::integer(const Wanted& wanted) {
  start_value(wanted);
  const char* first = *at_ == '+' && end_ - at_ > 1 && at_[1] != '-' ? at_ + 1 : at_;
  std::int64_t value = 0;
  const auto [stop, code] = std::from_chars(first, end_, value);
  if (code != std::errc{} || !ends_word(stop)) {
    fail_expected(wanted, "a whole number", rest_of_word());
  }
  at_ = stop;
  return value;
}

std::int64_t TextReader::integer(const Wanted& wanted, std::int64_t low, std::int64_t high) {
  const std::int64_t value = integer(wanted);
  if (value < low || value > high) {
    fail_expected(wanted, fmt::format("a whole number from {} to {}", low, high),
                  std::to_string(value));
  }
  return value;
}

int TextReader::label(const Wanted& wanted) {
  return static_cast<int>(
      integer(wanted, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()));
}

std::size_t TextReader::count(const Wanted& wanted, std::size_t values_per_record) {
  const std::int64_t value = integer(wanted);
  if (value < 0) {
    fail(fmt::format("{} is {}; 0 or more was expected", to_text(wanted), value),
         "correct the count, or export the file again");
  }
  // The last value of a file needs no blank behind it.
  const std::size_t room = (remaining() + 1) / (2 * values_per_record);
  if (static_cast<std::uint64_t>(value) > room) {
    fail(fmt::format("{} is {}, but the {} bytes that follow cannot hold more than {}",
                     to_text(wanted), value, remaining(), room),
         std::string(cut_short_remedy));
  }
  return static_cast<std::size_t>(value);
}

void TextReader::skip_values(std::size_t count, const Wanted& wanted) {
  for (std::size_t i = 0; i < count; ++i) word(wanted);
}

std::string_view TextReader::line_rest() {
  value_ = at_;
  value_line_ = line_;
  value_line_start_ = line_start_;
  const void* found = std::memchr(at_, '\n', remaining());
  const char* stop = found == nullptr ? end_ : static_cast<const char*>(found);
  std::string_view rest(at_, static_cast<std::size_t>(stop - at_));
  if (!rest.empty() && rest.back() == '\r') rest.remove_suffix(1);
  at_ = stop;
  if (at_ != end_) {
    ++at_;
    ++line_;
    line_start_ = at_;
  }
  return rest;
}

void TextReader::end_line(const Wanted& wanted) {
  if (!at_line_end()) start_value(wanted);
  if (!at_line_end()) fail_expected(wanted, "after a line break", rest_of_word());
  line_rest();
}

std::string_view TextReader::take(std::size_t bytes, const Wanted& wanted) {
  value_ = at_;
  if (bytes > remaining()) fail_end(wanted);
  const std::string_view taken(at_, bytes);
  at_ += bytes;
  return taken;
}

bool TextReader::find(std::string_view what) {
  const std::size_t place = text_.find(what, offset());
  if (place == text_.npos) return false;
  go_to(place);
  return true;
}

void TextReader::go_to(std::size_t place) {
  for (const char* stop = text_.data() + place; at_ != stop; ++at_) {
    if (*at_ == '\n') {
      ++line_;
      line_start_ = at_ + 1;
    }
  }
  value_ = nullptr;
}

void TextReader::fail(std::string message, std::string remedy) const {
  Location where{file_, 0, 0};
  const char* place = value_ == nullptr ? at_ : value_;
  if (binary_) {
    message += fmt::format(" (at byte {})", place - text_.data());
  } else if (value_ == nullptr) {
    where.line = line_;
    where.column = column_of(at_, line_start_);
  } else {
    where.line = value_line_;
    where.column = column_of(value_, value_line_start_);
  }
  throw Error(ErrorKind::input, std::move(message), std::move(remedy), std::move(where));
}

void TextReader::fail_file(std::string message, std::string remedy) const {
  throw Error(ErrorKind::input, std::move(message), std::move(remedy), {file_, 0, 0});
}

void TextReader::fail_expected(const Wanted& wanted, std::string_view kind,
                               std::string_view found) const {
  const std::string remedy =
      layout_.empty() ? std::string("correct this value, or export the file again")
                      : fmt::format("{} is written: {}; check this entry and the count before it",
                                    part_, layout_);
  fail(fmt::format("expected {} ({}), found {}", to_text(wanted), kind, quoted(found)), remedy);
}

void TextReader::fail_end(const Wanted& wanted) const {
  fail(fmt::format("the file ends where {} was expected", to_text(wanted)),
       std::string(cut_short_remedy));
}

std::string to_text(const Wanted& wanted) {
  std::string text(wanted.value);
  if (!wanted.of.empty()) text += fmt::format(" of {}", wanted.of);
  if (wanted.number >= 0) text += fmt::format(" {}", wanted.number);
  return text;
}

std::string quoted(std::string_view word) {
  constexpr std::size_t longest = 40;
  std::string text = "\"";
  for (const char c : word.substr(0, longest)) {
    if (c >= ' ' && c < 0x7f) {
      text += c;
    } else {
      text += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    }
  }
  text += word.size() > longest ? "...\"" : "\"";
  return text;
}

}  // namespace sinew::io
