// tbb::enumerable_thread_specific for the ThreadSanitizer build only: see ../README.md.
#pragma once

#include <atomic>
#include <map>

namespace tbb {

// A T for each thread that asks for one. No lock and no shared table: they would order the threads'
// other accesses as well, and hide races between them.
template <typename T>
class enumerable_thread_specific {
 public:
  T& local() {
    thread_local std::map<unsigned long, T> values;
    return values[id_];
  }

 private:
  static unsigned long next() {
    static std::atomic<unsigned long> last{0};
    return last.fetch_add(1, std::memory_order_relaxed);
  }
  unsigned long id_ = next();
};

}  // namespace tbb
