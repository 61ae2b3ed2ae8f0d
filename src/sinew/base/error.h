// Typed errors: the public sinew/error.h is the one place that defines them.
#pragma once

#include <sinew/error.h>  // IWYU pragma: export
