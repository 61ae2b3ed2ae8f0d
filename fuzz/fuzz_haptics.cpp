// Treats any text as a recorded path, and as a message of a haptic device over the network. Each is
// refused with an Error, or the values are numbers.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "sinew/base/error.h"
#include "sinew/haptics/loop.h"
#include "sinew/server/network_device.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    sinew::RecordedPath path = sinew::RecordedPath::from_text(text);
    for (int k = 0; k < 20; ++k)
      for (const double x : path.read(0.1 * k).position)
        if (std::isnan(x)) std::abort();
  } catch (const sinew::Error&) {
  }
  try {
    const sinew::HapticInput input = sinew::server::read_haptic_input(text);
    for (const double x : input.position)
      if (!std::isfinite(x)) std::abort();
  } catch (const sinew::Error&) {
  }
  return 0;
}
