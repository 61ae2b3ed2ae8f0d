// How long a blade's moves take: a stroke through a liver while it swings.
//   build/acc/bench/sinew_cutting scenes/liver.toml [THREADS [MOVES]]
#include <sinew/simulation.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace {

void print(const char* what, std::vector<double>& ms) {
  if (ms.empty()) return;
  std::sort(ms.begin(), ms.end());
  std::printf("%-22s %4zu  median %7.2f ms  worst %7.2f ms\n", what, ms.size(), ms[ms.size() / 2],
              ms.back());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: sinew_cutting SCENE [THREADS [MOVES]]\n");
    return 2;
  }
  const int threads = argc > 2 ? std::atoi(argv[2]) : 1;
  const int moves = argc > 3 ? std::atoi(argv[3]) : 150;
  try {
    auto simulation = sinew::Simulation::from_file(argv[1], {.threads = threads});
    simulation.advance(0.1);
    const auto blade = simulation.add_blade();
    std::vector<double> cutting, idle;
    for (int i = 0; i <= moves; ++i) {
      const double z = 0.12 - 0.15 * i / moves;
      const auto start = std::chrono::steady_clock::now();
      const auto report = simulation.move(blade, {0.03, 0.10, z}, {0.03, -0.14, z});
      const std::chrono::duration<double, std::milli> took =
          std::chrono::steady_clock::now() - start;
      (report.opened > 0 ? cutting : idle).push_back(took.count());
      simulation.advance(1.0 / 60.0);
    }
    print("moves that cut", cutting);
    print("others", idle);
    std::printf("state %s\n", simulation.hash().c_str());
  } catch (const sinew::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
