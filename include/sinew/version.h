// The version of the library.
#pragma once

#include <sinew/export.h>

#define SINEW_VERSION_MAJOR 0
#define SINEW_VERSION_MINOR 2
#define SINEW_VERSION_PATCH 0

namespace sinew {

// "0.2.0": of the library that is linked, which may differ from that of the headers.
SINEW_API const char* version() noexcept;

}  // namespace sinew
