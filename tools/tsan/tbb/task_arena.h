// tbb::task_arena without effect, for the ThreadSanitizer build only: see ../README.md.
#pragma once

namespace tbb {

class task_arena {
 public:
  explicit task_arena(int) {}
  template <typename F>
  void execute(const F& f) {
    f();
  }
};

}  // namespace tbb
