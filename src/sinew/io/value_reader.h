// Numbers of a file in text or binary form, read through one interface, so that the parsers of Gmsh
// and legacy VTK are written once.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>
#include <type_traits>

#include "sinew/io/text_reader.h"

namespace sinew::io {

// A number from raw bytes, in this machine's byte order or the opposite one.
template <typename T>
T from_bytes(const char* bytes, bool swap) {
  std::array<char, sizeof(T)> buffer;
  std::memcpy(buffer.data(), bytes, sizeof(T));
  if (swap) std::reverse(buffer.begin(), buffer.end());
  return std::bit_cast<T>(buffer);
}

template <typename T>
void append_bytes(std::string& out, T value, bool swap = false) {
  auto buffer = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (swap) std::reverse(buffer.begin(), buffer.end());
  out.append(buffer.data(), buffer.size());
}

class ValueReader {
 public:
  explicit ValueReader(TextReader& text) : text_(text) {}

  // The following numbers are raw bytes; swap: in the opposite byte order of this machine.
  void set_binary(bool swap) {
    text_.set_binary();
    swap_ = swap;
  }
  bool binary() const { return text_.binary(); }

  // One number of the file's type T. A text number must be in the range of T.
  template <typename T>
  T value(const Wanted& wanted) {
    if (binary()) return from_bytes<T>(text_.take(sizeof(T), wanted).data(), swap_);
    if constexpr (std::is_floating_point_v<T>) {
      return static_cast<T>(text_.real(wanted));
    } else {
      constexpr auto high = static_cast<std::uint64_t>(std::numeric_limits<T>::max());
      constexpr auto most = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
      return static_cast<T>(text_.integer(wanted,
                                          static_cast<std::int64_t>(std::numeric_limits<T>::min()),
                                          static_cast<std::int64_t>(std::min(high, most))));
    }
  }

  // Error unless `count` records of this many values and bytes can follow.
  void check_room(std::uint64_t count, std::uint64_t values_each, std::uint64_t bytes_each,
                  const Wanted& wanted) const;

 private:
  TextReader& text_;
  bool swap_ = false;
};

inline void ValueReader::check_room(std::uint64_t count, std::uint64_t values_each,
                                    std::uint64_t bytes_each, const Wanted& wanted) const {
  const std::uint64_t left = text_.remaining();
  const std::uint64_t room = text_.binary() ? left / bytes_each : (left + 1) / (2 * values_each);
  if (count <= room) return;
  text_.fail(to_text(wanted) + " is " + std::to_string(count) + ", but the " +
                 std::to_string(left) + " bytes that follow cannot hold more than " +
                 std::to_string(room),
             "the file was cut short or its count is too large: fetch it again, or correct the "
             "count");
}

}  // namespace sinew::io
