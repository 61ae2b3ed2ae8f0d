// A 64-bit hash of plain data: names a state, a scene or a mesh, so that two runs can be compared.
// FNV-1a (Fowler, Noll, Vo), applied to bytes. Not cryptographic.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace sinew {

class Hash {
 public:
  void bytes(const void* data, std::size_t size);
  void text(std::string_view s) {
    value(s.size());
    bytes(s.data(), s.size());
  }
  template <typename T>
  requires std::is_arithmetic_v<T>
  void value(T v) { bytes(&v, sizeof v); }
  // Elements without padding: numbers, fixed-size vectors of them.
  template <typename T>
  void array(const std::vector<T>& v) {
    value(v.size());
    if (!v.empty()) bytes(v.data(), v.size() * sizeof(T));
  }

  std::uint64_t digest() const { return state_; }

 private:
  std::uint64_t state_ = 14695981039346656037ULL;
};

// 16 lower-case hexadecimal digits.
std::string hex(std::uint64_t digest);

}  // namespace sinew
