#include "sinew/base/cancel.h"

#include <gtest/gtest.h>

#include <thread>

namespace sinew {
namespace {

TEST(Cancel, WithoutAScopeNothingIsCancelled) {
  EXPECT_FALSE(is_cancelled());
  EXPECT_NO_THROW(stop_if_cancelled());
}

TEST(Cancel, AnotherThreadEndsTheLoop) {
  std::atomic<bool> flag{false};
  bool ended = false;
  std::thread worker([&] {
    const CancelScope scope(flag);
    try {
      while (true) stop_if_cancelled();
    } catch (const Cancelled&) {
      ended = true;
    }
  });
  flag = true;
  worker.join();
  EXPECT_TRUE(ended);
}

TEST(Cancel, TheScopeBeforeIsRestored) {
  const std::atomic<bool> outer{false}, inner{true};
  const CancelScope a(outer);
  {
    const CancelScope b(inner);
    EXPECT_TRUE(is_cancelled());
  }
  EXPECT_FALSE(is_cancelled());
}

}  // namespace
}  // namespace sinew
