// A made-up machine for the tests of bench*.
#pragma once

#include "sinew/study/bench_machine.h"

namespace sinew::study::test {

inline MachineLimits limits(int threads) {
  MachineLimits m;
  m.threads = threads;
  m.level = {Bandwidth{1e6, 40e9, 50e9}, Bandwidth{16e6, 20e9, 18e9}, Bandwidth{4e8, 10e9, 9e9}};
  m.flops = 100e9;
  m.clock = 2e9;
  m.fma_per_cycle = 2.0;
  return m;
}

inline constexpr CacheSizes caches{1e6, 30e6};

}  // namespace sinew::study::test
