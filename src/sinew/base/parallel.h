// Loops over many items on many threads. The results do not depend on the thread count: the items
// are divided into blocks of a fixed size, and sums are added up block by block in order.
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "sinew/base/vec.h"

namespace sinew {

// Items in a block. Large enough to hide the cost of passing a block to a thread (about 1 us).
inline constexpr Index block_size = 1024;

inline Index block_count(Index n) {
  return (n + block_size - 1) / block_size;
}

inline Range block(Index b, Index n) {
  return {b * block_size, std::min(n, (b + 1) * block_size)};
}

// Calls f(block index, range) for every block of [0, n).
template <typename F>
void parallel_blocks(Index n, const F& f) {
  const Index blocks = block_count(n);
  constexpr Index few = 4;  // waking threads for them would take longer
  if (blocks <= few) {
    for (Index b = 0; b < blocks; ++b) f(b, block(b, n));
    return;
  }
  tbb::parallel_for(Index{0}, blocks, [&](Index b) { f(b, block(b, n)); });
}

// Calls f(i) for every i in [0, n). For tasks that are each much work.
template <typename F>
void parallel_tasks(Index n, const F& f) {
  if (n == 1) return f(0);
  tbb::parallel_for(Index{0}, n, [&](Index i) { f(i); });
}

// Calls f(i) for every i in [0, n).
template <typename F>
void parallel_for(Index n, const F& f) {
  parallel_blocks(n, [&](Index, Range r) {
    for (Index i = r.begin; i < r.end; ++i) f(i);
  });
}

// Combines f(range) of every block in the order of the blocks, starting from `init`.
template <typename T, typename F, typename Combine>
T parallel_reduce(Index n, T init, const F& f, const Combine& combine) {
  std::vector<T> parts(static_cast<std::size_t>(block_count(n)), init);
  parallel_blocks(n, [&](Index b, Range r) { parts[static_cast<std::size_t>(b)] = f(r); });
  for (const T& part : parts) init = combine(init, part);
  return init;
}

// Sum of f(i) over [0, n), in a fixed order.
template <typename F>
double parallel_sum(Index n, const F& f) {
  return parallel_reduce(
      n, 0.0,
      [&](Range r) {
        double sum = 0.0;
        for (Index i = r.begin; i < r.end; ++i) sum += f(i);
        return sum;
      },
      [](double a, double b) { return a + b; });
}

// Threads that may work at a time.
int threads_allowed();

// While an object of this class lives, at most `threads` threads run the loops above (0: all of the
// machine).
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  void* control_ = nullptr;
};

}  // namespace sinew
