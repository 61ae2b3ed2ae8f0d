// Marks the symbols that a shared library of Sinew exports.
#pragma once

#if defined(__GNUC__)
#define SINEW_API __attribute__((visibility("default")))
#else
#define SINEW_API
#endif
