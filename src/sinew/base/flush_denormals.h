// While an object of this class lives, denormal floats count as zero in its thread: arithmetic on
// them takes a hundred times as long on many processors.
#pragma once

#include <cstdint>

namespace sinew {

class FlushDenormals {
 public:
  FlushDenormals();
  ~FlushDenormals();
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  std::uint64_t before_ = 0;  // the thread's control register
};

}  // namespace sinew
