// A 64-bit hash of plain data. It identifies a state, a scene or a mesh, so that two runs can be
// compared. XXH64 of the bytes (xxhash.com). Not cryptographic.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

struct XXH64_state_s;

namespace sinew {

class Hash {
 public:
  Hash();
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

  std::uint64_t digest() const;

 private:
  struct Free {
    void operator()(XXH64_state_s* state) const;
  };
  std::unique_ptr<XXH64_state_s, Free> state_;
};

// 16 lower-case hexadecimal digits.
std::string hex(std::uint64_t digest);

}  // namespace sinew
