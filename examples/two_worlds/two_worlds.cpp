// Two simulations in two threads: they share nothing, and each gives the bits that it gives alone.
#include <sinew/sinew.h>

#include <cstdio>
#include <string>
#include <thread>

namespace {

constexpr const char* kScene = R"(
[body.block]
shape = "box"
cells = [4, 4, 4]
size = [0.1, 0.1, 0.1]
young = 5e3
[pin.top]
select = { side = "+y" }
)";

// The hash of the state after a fifth of a second, or what went wrong.
std::string simulate(const std::string& stiffness) {
  try {
    sinew::SimulationOptions options;
    options.threads = 1;  // of its own; the two do not wait for each other
    options.set = {"block.young=" + stiffness};
    auto simulation = sinew::Simulation::from_text(kScene, options);
    simulation.advance(0.2);
    return simulation.hash();
  } catch (const sinew::Error& error) {
    return error.what();
  }
}

}  // namespace

int main() {
  std::string soft, stiff;
  std::thread first([&] { soft = simulate("5e3"); });
  std::thread second([&] { stiff = simulate("50e3"); });
  first.join();
  second.join();
  std::printf("soft: %s\nstiff: %s\n", soft.c_str(), stiff.c_str());
  const bool same = soft == simulate("5e3") && stiff == simulate("50e3");
  std::puts(same ? "alone: the same bits" : "alone: other bits");
  return same && soft != stiff ? 0 : 1;
}
