#include "sinew/io/base64.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "sinew/io/text_reader.h"

namespace sinew::io {
namespace {

constexpr std::string_view alphabet =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::uint8_t not_base64 = 255;

constexpr std::array<std::uint8_t, 256> make_values() {
  std::array<std::uint8_t, 256> value_of_character{};
  value_of_character.fill(not_base64);
  for (std::size_t i = 0; i < alphabet.size(); ++i) {
    value_of_character[static_cast<unsigned char>(alphabet[i])] = static_cast<std::uint8_t>(i);
  }
  return value_of_character;
}
constexpr std::array<std::uint8_t, 256> value_of_character = make_values();

}  // namespace

std::string encode_base64(std::string_view bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t length = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (k < length ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= length ? alphabet[group >> (18 - 6 * k) & 63U] : '=';
    }
  }
  return text;
}

std::size_t Base64Reader::remaining() const {
  return pending_.size() + (text_.size() - at_ + 3) / 4 * 3;
}

bool Base64Reader::decode_group() {
  std::uint32_t group = 0;
  std::size_t digits = 0;
  std::size_t padding = 0;
  while (digits + padding < 4) {
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
    if (at_ == text_.size()) return false;
    const char c = text_[at_];
    const std::uint8_t value = value_of_character[static_cast<unsigned char>(c)];
    if (c == '=' && digits >= 2) {
      ++padding;
    } else if (value != not_base64 && padding == 0) {
      ++digits;
    } else {
      bad_at_ = at_;
      return false;
    }
    group = group << 6 | (c == '=' ? 0U : value);
    ++at_;
  }
  for (std::size_t k = 0; k + 1 < digits; ++k) {
    pending_ += static_cast<char>(static_cast<unsigned char>(group >> (16 - 8 * k) & 255U));
  }
  return true;
}

// Whole groups without blanks or padding, straight into place: nearly all of a file.
std::size_t Base64Reader::decode_plain_groups(char* bytes, std::size_t most) {
  std::size_t done = 0;
  for (; done + 3 <= most && at_ + 4 <= text_.size(); done += 3, at_ += 4) {
    std::uint32_t group = 0;
    std::uint32_t all = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::uint32_t value = value_of_character[static_cast<unsigned char>(text_[at_ + k])];
      group = group << 6 | value;
      all |= value;
    }
    if (all >= 64) break;
    for (std::size_t k = 0; k < 3; ++k) {
      bytes[done + k] = static_cast<char>(static_cast<unsigned char>(group >> (16 - 8 * k) & 255U));
    }
  }
  return done;
}

bool Base64Reader::read(std::size_t count, std::string& bytes) {
  if (count > remaining()) return false;
  const std::size_t start = bytes.size();
  bytes.resize(start + count);
  std::size_t done = 0;
  while (done < count) {
    char* out = bytes.data() + start + done;
    if (pending_.empty()) {
      const std::size_t plain = decode_plain_groups(out, count - done);
      done += plain;
      if (plain > 0) continue;
      if (!decode_group()) break;
    }
    const std::size_t taken = pending_.copy(out, count - done);
    pending_.erase(0, taken);
    done += taken;
  }
  bytes.resize(start + done);
  return done == count;
}

}  // namespace sinew::io
