#include <cstddef>
#include <cstdint>

#include "fuzz/io_targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  sinew::fuzz::image({reinterpret_cast<const char*>(data), size});
  return 0;
}
