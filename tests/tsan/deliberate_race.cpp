// A parallel loop with a race between neighbouring blocks, which ThreadSanitizer has to report: the
// test of our thread sanitizer build. Without the race (first loop) it has nothing to report.
#include <cstdio>
#include <vector>

#include "sinew/base/parallel.h"

int main() {
  const sinew::Index n = 10 * sinew::block_size;
  std::vector<double> x(static_cast<std::size_t>(n), 1.0);
  auto at = [&](sinew::Index i) -> double& { return x[static_cast<std::size_t>(i)]; };
  sinew::parallel_for(n, [&](sinew::Index i) { at(i) += 1.0; });
  std::puts("no race so far");
  sinew::parallel_for(n, [&](sinew::Index i) { at((i + 1) % n) += at(i); });
  std::printf("%g\n", at(0));
}
