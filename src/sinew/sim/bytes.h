// Plain values as bytes, and back, for checkpoints and saved states. Little-endian.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include "sinew/base/hash.h"

namespace sinew {

static_assert(std::endian::native == std::endian::little, "files of states are little-endian");

// The writer and the reader have the same functions, so one list of members serves both.
class ByteWriter {
 public:
  explicit ByteWriter(std::string_view start) : bytes(start) {}

  template <typename T>
  void value(const T& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes.append(reinterpret_cast<const char*>(&v), sizeof v);
  }
  template <typename Array>
  void array(const Array& v) {
    value(static_cast<std::uint64_t>(v.size()));
    bytes.append(reinterpret_cast<const char*>(v.data()),
                 v.size() * sizeof(typename Array::value_type));
  }
  template <typename Vector>
  void vec(const Vector& v) {
    for (int a = 0; a < 3; ++a) value(v[a]);
  }
  std::string bytes;
};

// After the first value that is missing, every further read fails too.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  template <typename T>
  void value(T& v) {
    if (bytes_.size() < sizeof v) return fail();
    std::memcpy(&v, bytes_.data(), sizeof v);
    bytes_.remove_prefix(sizeof v);
  }
  template <typename Array>
  void array(Array& v) {
    constexpr std::size_t each = sizeof(typename Array::value_type);
    const std::size_t size = count(each);
    v.resize(size);
    if (size > 0) std::memcpy(static_cast<void*>(v.data()), bytes_.data(), size * each);
    bytes_.remove_prefix(size * each);
  }
  template <typename Vector>
  void vec(Vector& v) {
    for (int a = 0; a < 3; ++a) value(v[a]);
  }
  // The number of items, of at least `each` bytes, that follow.
  std::size_t count(std::size_t each) {
    std::uint64_t n = 0;
    value(n);
    if (n > bytes_.size() / each) fail();
    return good_ ? static_cast<std::size_t>(n) : 0;
  }
  std::string_view text(std::size_t size) {
    if (bytes_.size() < size) fail();
    if (!good_) return {};
    const std::string_view out = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return out;
  }
  bool all_read() const { return good_ && bytes_.empty(); }

 private:
  void fail() {
    good_ = false;
    bytes_ = {};
  }
  std::string_view bytes_;
  bool good_ = true;
};

// The checksum at the end of a checkpoint or a saved state.
inline std::uint64_t digest(std::string_view bytes) {
  Hash h;
  h.bytes(bytes.data(), bytes.size());
  return h.digest();
}

}  // namespace sinew
