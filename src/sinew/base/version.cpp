#include <sinew/version.h>

namespace sinew {

const char* version() noexcept {
  return SINEW_VERSION;
}

}  // namespace sinew
