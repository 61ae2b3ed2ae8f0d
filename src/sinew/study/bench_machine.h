// The measured limits of the machine: the rate at which memory of three sizes is copied, and the
// processor's multiply-adds per second.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "sinew/study/bench_timer.h"

namespace sinew::study {

// As the system reports; otherwise 1 MiB and 8 MiB.
struct CacheSizes {
  double l2 = 0.0;  // [B] of one core
  double l3 = 0.0;  // [B] of all
};
CacheSizes cache_sizes();

enum class MemoryLevel { l2, l3, memory };
inline constexpr std::array<const char*, 3> level_names = {"L2", "L3", "memory"};

// The nearest level that holds this many bytes, spread over the threads' cores.
MemoryLevel level_of(const CacheSizes& caches, double bytes, int threads);

struct Bandwidth {
  double bytes = 0.0;  // of the arrays, all threads together [B]
  double copy = 0.0;   // [B/s] read and written
  double triad = 0.0;  // [B/s] of a = b + c / 2
  double best() const { return copy > triad ? copy : triad; }
};

// The best rates of the machine on this many threads.
struct MachineLimits {
  int threads = 1;
  std::array<Bandwidth, 3> level;  // by MemoryLevel
  double flops = 0.0;              // [1/s] in single precision, a multiply-add counts twice
  double clock = 0.0;              // [Hz] of one core under that load
  double fma_per_cycle = 0.0;      // vector multiply-adds that one core starts in a cycle
};

struct Machine {
  std::string processor;        // as the system names it
  std::string instruction_set;  // as Highway names it
  int lanes = 0;                // floats in its vectors
  int cores = 0;                // that the system reports
  CacheSizes caches;
};
Machine describe_machine();

// Takes about ten times options.seconds. Nothing if options.stop was set.
std::optional<MachineLimits> measure_limits(const CacheSizes& caches, int threads,
                                            const TimerOptions& options);

}  // namespace sinew::study
