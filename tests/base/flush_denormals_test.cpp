#include "sinew/base/flush_denormals.h"

#include <gtest/gtest.h>

#include <limits>

namespace sinew {
namespace {

// Computed at run time, not by the compiler.
float half_of(float value) {
  const volatile float x = value;
  return x * 0.5f;
}

TEST(FlushDenormals, ActsDuringTheLifetimeOfTheObject) {
  constexpr float smallest = std::numeric_limits<float>::min();
  EXPECT_GT(half_of(smallest), 0.0f);
#if defined(__x86_64__) || defined(__aarch64__)
  {
    const FlushDenormals flush;
    EXPECT_EQ(half_of(smallest), 0.0f);
    EXPECT_EQ(half_of(2.0f * smallest), smallest);
  }
#endif
  EXPECT_GT(half_of(smallest), 0.0f);
}

}  // namespace
}  // namespace sinew
