#include "sinew/base/hash.h"

#include <fmt/format.h>

// The code of xxhash comes with its header: no library to link, no symbol that another copy shares.
#define XXH_STATIC_LINKING_ONLY
#define XXH_IMPLEMENTATION
#define XXH_NAMESPACE sinew_
#include <xxhash.h>

#include <new>

namespace sinew {

Hash::Hash() : state_(XXH64_createState()) {
  if (!state_) throw std::bad_alloc();
  XXH64_reset(state_.get(), 0);
}

void Hash::Free::operator()(XXH64_state_s* state) const {
  XXH64_freeState(state);
}

void Hash::bytes(const void* data, std::size_t size) {
  XXH64_update(state_.get(), data, size);
}

std::uint64_t Hash::digest() const {
  return XXH64_digest(state_.get());
}

std::string hex(std::uint64_t digest) {
  return fmt::format("{:016x}", digest);
}

}  // namespace sinew
