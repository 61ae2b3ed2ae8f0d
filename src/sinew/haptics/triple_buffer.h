// The newest value that one thread writes and another one reads, without a lock.
#pragma once

#include <array>
#include <atomic>

namespace sinew {

// The writer fills one value, the reader holds another, and the third is the newest finished one.
// Each side changes its own for the third by one atomic exchange.
template <typename T>
class TripleBuffer {
 public:
  void write(const T& value) {
    values_[writing_] = value;
    writing_ = newest_.exchange(writing_ | fresh, std::memory_order_acq_rel) & ~fresh;
  }
  // Whether there is a newer one than that of the last call.
  bool update() {
    if ((newest_.load(std::memory_order_relaxed) & fresh) == 0) return false;
    reading_ = newest_.exchange(reading_, std::memory_order_acq_rel) & ~fresh;
    return true;
  }
  const T& value() const { return values_[reading_]; }  // of the last update()

 private:
  static constexpr unsigned fresh = 4;
  std::array<T, 3> values_{};
  unsigned writing_ = 0, reading_ = 1;
  std::atomic<unsigned> newest_{2};
};

}  // namespace sinew
