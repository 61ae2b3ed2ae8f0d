// tbb::parallel_for on std::thread, for the ThreadSanitizer build only: see ../README.md.
#pragma once

#include <array>
#include <cstddef>
#include <exception>
#include <thread>

namespace tbb {

// Calls f(i) for every i in [begin, end). Thread t takes begin + t, begin + t + 4, ...; nothing but
// the threads' start and end orders the calls.
template <typename Index, typename F>
void parallel_for(Index begin, Index end, const F& f) {
  constexpr std::size_t thread_count = 4;
  std::array<std::exception_ptr, thread_count> failures;
  std::array<std::thread, thread_count> threads;
  for (std::size_t t = 0; t < thread_count; ++t) {
    threads[t] = std::thread([&, t] {
      try {
        for (Index i = begin + static_cast<Index>(t); i < end;
             i += static_cast<Index>(thread_count))
          f(i);
      } catch (...) {
        failures[t] = std::current_exception();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const std::exception_ptr& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
}

}  // namespace tbb
