// tbb::global_control without effect, for the ThreadSanitizer build only: see ../README.md.
#pragma once

#include <cstddef>

namespace tbb {

class global_control {
 public:
  enum parameter { max_allowed_parallelism };
  global_control(parameter, std::size_t) {}
  static std::size_t active_value(parameter) { return 4; }  // the threads of parallel_for.h
};

}  // namespace tbb
