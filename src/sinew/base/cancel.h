// Lets one thread end a long construction on another: reading a file, building a model. The loops
// of such work call stop_if_cancelled(), which throws once the flag of their thread is set.
#pragma once

#include <atomic>

namespace sinew {

// The work was cancelled. No Error: nothing was wrong, and handlers of errors must not hide it.
struct Cancelled {};

namespace detail {
inline thread_local const std::atomic<bool>* cancel_flag = nullptr;
}

// While an object of this class lives, setting `flag` cancels the work of this thread.
class CancelScope {
 public:
  explicit CancelScope(const std::atomic<bool>& flag) : before_(detail::cancel_flag) {
    detail::cancel_flag = &flag;
  }
  ~CancelScope() { detail::cancel_flag = before_; }
  CancelScope(const CancelScope&) = delete;
  CancelScope& operator=(const CancelScope&) = delete;

 private:
  const std::atomic<bool>* before_;
};

inline bool is_cancelled() {
  return detail::cancel_flag != nullptr && detail::cancel_flag->load(std::memory_order_relaxed);
}

// Throws Cancelled. Costs about a nanosecond.
inline void stop_if_cancelled() {
  if (is_cancelled()) throw Cancelled{};
}

}  // namespace sinew
