// Own threads for the loops of base/parallel.h, besides those of other owners in the same process.
#pragma once

#include <tbb/task_arena.h>

#include <memory>

namespace sinew {

class Arena {
 public:
  // At most `threads` threads, the caller included, run the loops of the function given to run().
  // 0: the arena of the calling thread.
  explicit Arena(int threads)
      : arena_(threads > 0 ? std::make_unique<tbb::task_arena>(threads) : nullptr) {}

  template <typename F>
  void run(const F& f) {
    if (arena_)
      arena_->execute(f);
    else
      f();
  }

 private:
  std::unique_ptr<tbb::task_arena> arena_;
};

}  // namespace sinew
