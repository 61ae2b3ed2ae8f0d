// The amount of work in a test. Sanitizers run code some twenty times slower: with them the long
// tests run the same code on fewer cases and for shorter times; the plain build has the full size.
#pragma once

namespace sinew::test {

#ifdef SINEW_SANITIZED
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif

// `full` in the plain build, a tenth of it under sanitizers.
constexpr double effort(double full) {
  return sanitized ? 0.1 * full : full;
}
constexpr int effort(int full) {
  return sanitized && full >= 10 ? full / 10 : full;
}

}  // namespace sinew::test
