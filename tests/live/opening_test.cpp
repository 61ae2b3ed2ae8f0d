#include "sinew/live/opening.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "sinew/base/cancel.h"
#include "sinew/base/error.h"
#include "sinew/sim/internals.h"
#include "tests/live/support.h"

namespace sinew::live {
namespace {

using namespace std::chrono_literals;

Simulation build(const Scene& scene) {
  return sim::simulate(scene, {});
}

void wait_for(const Opening& opening) {
  while (!opening.ended()) std::this_thread::sleep_for(1ms);
}

TEST(Opening, GivesTheSimulation) {
  std::atomic<int> ended{0};
  Opening opening({[] { return test::hanging_box(); }}, build, [&] { ++ended; });
  wait_for(opening);
  const Simulation simulation = opening.take();
  EXPECT_EQ(sim::internals(simulation).model().bodies[0].name, "box");
  while (ended == 0) std::this_thread::sleep_for(1ms);
}

TEST(Opening, PassesErrorsOn) {
  Opening opening({[]() -> Scene { throw Error(ErrorKind::input, "no such scene"); }}, build,
                  [] {});
  wait_for(opening);
  EXPECT_THROW(opening.take(), Error);
}

TEST(Opening, EndsSoonWhereItIsCancelled) {
  const auto start = std::chrono::steady_clock::now();
  {
    Opening opening({[]() -> Scene {
                      while (true) stop_if_cancelled();
                    }},
                    build, [] {});
    std::this_thread::sleep_for(5ms);
  }
  EXPECT_LT(std::chrono::steady_clock::now() - start, 60s);
}

// A million and a half tets: the reader, the assembly and the search for the step all look.
TEST(Opening, EndsInTheMiddleOfALargeModel) {
  Opening opening({[] { return test::hanging_box({"box.cells=[60,60,60]"}); }}, build, [] {});
  std::this_thread::sleep_for(20ms);
  opening.cancel();
  wait_for(opening);
  EXPECT_THROW(opening.take(), Cancelled);
}

}  // namespace
}  // namespace sinew::live
