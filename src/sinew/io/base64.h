// Base64 (RFC 4648), as the VTK XML formats use it: several encoded pieces may follow each other,
// each with its own padding.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace sinew::io {

std::string encode_base64(std::string_view bytes);

// Decodes on demand. Blanks between characters are skipped; a padded group ends a piece and the
// next piece starts behind it.
class Base64Reader {
 public:
  explicit Base64Reader(std::string_view text) : text_(text) {}

  // Appends exactly `count` bytes to `bytes`; false if the text ends earlier or is not Base64
  // (`bad_at` then holds the place).
  bool read(std::size_t count, std::string& bytes);
  // Upper bound of the remaining bytes.
  std::size_t remaining() const;
  std::optional<std::size_t> bad_at() const { return bad_at_; }

 private:
  std::size_t decode_plain_groups(char* bytes, std::size_t most);
  bool decode_group();

  std::string_view text_;
  std::size_t at_ = 0;
  std::string pending_;  // bytes of the last group that were not requested yet: at most 2
  std::optional<std::size_t> bad_at_;
};

}  // namespace sinew::io
