#include <sinew/version.h>

#define SINEW_TEXT_OF(x) #x
#define SINEW_TEXT(x) SINEW_TEXT_OF(x)

namespace sinew {

const char* version() noexcept {
  return SINEW_TEXT(SINEW_VERSION_MAJOR) "." SINEW_TEXT(SINEW_VERSION_MINOR) "." SINEW_TEXT(
      SINEW_VERSION_PATCH);
}

}  // namespace sinew
