// tbb::enumerable_thread_specific for the ThreadSanitizer build only: see ../README.md.
#pragma once

#include <map>
#include <mutex>
#include <thread>

namespace tbb {

// A T for each thread that asks for one.
template <typename T>
class enumerable_thread_specific {
 public:
  T& local() {
    const std::lock_guard lock(mutex_);
    return values_[std::this_thread::get_id()];  // a map does not move them
  }

 private:
  std::mutex mutex_;
  std::map<std::thread::id, T> values_;
};

}  // namespace tbb
