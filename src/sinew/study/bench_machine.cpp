#include "sinew/study/bench_machine.h"

#include <fmt/format.h>
#include <hwy/aligned_allocator.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <thread>
#include <vector>

#include "sinew/study/bench_loops.h"

namespace sinew::study {
namespace {

constexpr double KiB = 1024.0, MiB = 1024.0 * KiB, GiB = 1024.0 * MiB;

// "2048K" as sysfs writes it, in bytes; 0 if it cannot be read.
double read_size(const std::string& path) {
  std::ifstream file(path);
  std::string text;
  if (!(file >> text)) return 0.0;
  const double number = std::strtod(text.c_str(), nullptr);
  return number * (text.back() == 'K' ? KiB : text.back() == 'M' ? MiB : 1.0);
}

double cache_size(int level) {
  for (int i = 0; i < 8; ++i) {
    const std::string folder = fmt::format("/sys/devices/system/cpu/cpu0/cache/index{}/", i);
    std::ifstream file(folder + "level");
    int found = 0;
    if (file >> found && found == level) return read_size(folder + "size");
  }
#ifdef _SC_LEVEL2_CACHE_SIZE
  const long known = sysconf(level == 2 ? _SC_LEVEL2_CACHE_SIZE : _SC_LEVEL3_CACHE_SIZE);
  if (known > 0) return static_cast<double>(known);
#endif
  return 0.0;
}

// Size of all arrays together that measures a level [B]: well within the level, and well beyond the
// one before. A shared L3 is not available entirely: a few times L2 is.
double array_bytes(MemoryLevel level, const CacheSizes& caches, int threads) {
  const double l2 = caches.l2 * threads;
  switch (level) {
    case MemoryLevel::l2:
      return 0.5 * l2;
    case MemoryLevel::l3:
      return std::max(2.0 * l2, std::min(8.0 * caches.l2, 0.25 * caches.l3));
    case MemoryLevel::memory:
      break;
  }
  return std::clamp(4.0 * caches.l3, 256.0 * MiB, 1.0 * GiB);
}

// Calls f(thread) on this many threads at once, including the caller's.
void on_threads(int threads, const std::function<void(int)>& f) {
  std::vector<std::thread> others;
  for (int t = 1; t < threads; ++t) others.emplace_back(f, t);
  f(0);
  for (std::thread& other : others) other.join();
}

// Best rate [1/s] of the amount that `run(thread)` returns, over all threads.
std::optional<double> rate(int threads, const TimerOptions& options,
                           const std::function<double(int)>& run) {
  std::vector<double> amount(static_cast<std::size_t>(threads));
  const auto time = measure(
      options, [] {},
      [&] { on_threads(threads, [&](int t) { amount[static_cast<std::size_t>(t)] = run(t); }); });
  if (!time) return std::nullopt;
  double sum = 0.0;
  for (const double a : amount) sum += a;
  return sum / time->min;
}

// With fewer bytes than this, the start of threads would dominate the measurement.
constexpr double bytes_a_run = 64.0 * MiB;

std::optional<Bandwidth> measure_bandwidth(double bytes, int threads, const TimerOptions& options) {
  const auto own = static_cast<std::size_t>(bytes / threads);
  // The third array is the triad's; copying takes two larger ones.
  const std::size_t half = own / 2 / sizeof(float) / 64 * 64;
  const std::size_t third = own / 3 / sizeof(float) / 64 * 64;
  std::vector<hwy::AlignedFreeUniquePtr<float[]>> arrays;
  for (int t = 0; t < threads; ++t) {
    arrays.push_back(hwy::AllocateAligned<float>(2 * half));
    std::fill_n(arrays.back().get(), 2 * half, 1.0f);
  }
  const int passes = std::max(1, static_cast<int>(bytes_a_run / static_cast<double>(own)));
  const auto copy = rate(threads, options, [&](int t) {
    float* a = arrays[static_cast<std::size_t>(t)].get();
    for (int p = 0; p < passes; ++p) copy_floats(a, a + half, half);
    return static_cast<double>(passes) * static_cast<double>(2 * half * sizeof(float));
  });
  if (!copy) return std::nullopt;
  const auto triad = rate(threads, options, [&](int t) {
    float* a = arrays[static_cast<std::size_t>(t)].get();
    for (int p = 0; p < passes; ++p) triad_floats(a, a + third, a + 2 * third, third);
    return static_cast<double>(passes) * static_cast<double>(3 * third * sizeof(float));
  });
  if (!triad) return std::nullopt;
  return Bandwidth{bytes, *copy, *triad};
}

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos) {
      return line.substr(colon + 2);
    }
  }
  return "unknown";
}

}  // namespace

CacheSizes cache_sizes() {
  CacheSizes caches{cache_size(2), cache_size(3)};
  if (!(caches.l2 > 0.0)) caches.l2 = 1.0 * MiB;
  if (!(caches.l3 > caches.l2)) caches.l3 = 8.0 * caches.l2;
  return caches;
}

MemoryLevel level_of(const CacheSizes& caches, double bytes, int threads) {
  if (bytes <= caches.l2 * threads) return MemoryLevel::l2;
  return bytes <= caches.l3 ? MemoryLevel::l3 : MemoryLevel::memory;
}

Machine describe_machine() {
  Machine machine;
  machine.processor = processor_name();
  machine.instruction_set = instruction_set();
  machine.lanes = static_cast<int>(float_lanes());
  machine.cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  machine.caches = cache_sizes();
  return machine;
}

std::optional<MachineLimits> measure_limits(const CacheSizes& caches, int threads,
                                            const TimerOptions& options) {
  MachineLimits limits;
  limits.threads = threads;
  for (const MemoryLevel level : {MemoryLevel::l2, MemoryLevel::l3, MemoryLevel::memory}) {
    const auto found = measure_bandwidth(array_bytes(level, caches, threads), threads, options);
    if (!found) return std::nullopt;
    limits.level[static_cast<std::size_t>(level)] = *found;
  }
  constexpr std::size_t rounds = 1 << 20;
  const auto flops = rate(threads, options, [](int) { return multiply_add(rounds); });
  const auto clock = rate(1, options, [](int) { return cycles(rounds); });
  if (!flops || !clock) return std::nullopt;
  limits.flops = *flops;
  limits.clock = *clock;
  limits.fma_per_cycle = *flops / threads / *clock / (2.0 * static_cast<double>(float_lanes()));
  return limits;
}

}  // namespace sinew::study
