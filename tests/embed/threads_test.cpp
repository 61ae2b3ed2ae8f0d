// Simulations in the threads of a host.
#include <thread>

#include "tests/embed/misuse.h"

namespace embed {
namespace {

using sinew::ErrorKind;
using sinew::Simulation;

// A grid large enough that its loops run in parallel.
sinew::SceneBuilder larger_scene() {
  sinew::SceneBuilder scene;
  scene.add_body({.name = "slab",
                  .shape = "box",
                  .cells = {{14, 14, 14}},
                  .size = {{0.1, 0.1, 0.1}},
                  .position = {{0.05, 0.05, 0.05}},
                  .material = {.young = 5e3}});
  scene.add_pin({.name = "floor", .select = {.side = "-y"}});
  scene.add_obstacle({.name = "ball", .center = {{0.05, 0.115, 0.05}}, .radius = 0.02});
  return scene;
}

std::string pressed(int threads, int steps) {
  Simulation s(larger_scene(), {.threads = threads});
  const auto ball = s.obstacle("ball");
  for (int i = 0; i < steps; ++i) {
    s.move(ball, {.center = {0.05, 0.115 - 2e-4 * i, 0.05}});
    s.step();
  }
  return s.hash();
}

TEST(Threads, TheSameBitsWithAnyNumberOfThem) {
  const std::string one = pressed(1, 10);
  EXPECT_EQ(pressed(2, 10), one);
  EXPECT_EQ(pressed(5, 10), one);
  EXPECT_EQ(pressed(0, 10), one);
}

TEST(Threads, SimulationsInSeveralThreadsDoNotMeet) {
  const std::string alone = pressed(1, 6);
  std::vector<std::string> hashes(3);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < hashes.size(); ++i)
    threads.emplace_back([&, i] { hashes[i] = pressed(static_cast<int>(i), 6); });
  for (std::thread& t : threads) t.join();
  for (const std::string& hash : hashes) EXPECT_EQ(hash, alone);
}

TEST(Threads, ASimulationMayGoFromThreadToThread) {
  Simulation s = box_simulation();
  s.step();
  std::thread([&] { s.step(); }).join();
  std::thread([moved = std::move(s)]() mutable { moved.step(); }).join();
}

TEST(Threads, ASecondThreadIsRefusedAndAnInterruptEndsTheFirst) {
  Simulation s(larger_scene());
  bool arrived = true;
  std::thread first([&] {
    while (arrived) {
      try {
        arrived = s.advance(3600.0);
      } catch (const sinew::Error&) {  // the second thread had it
      }
    }
  });
  bool refused = false;
  while (!refused) {
    try {
      s.take_events();
      std::this_thread::yield();
    } catch (const sinew::Error&) {
      refused = true;
    }
  }
  expect_error(ErrorKind::usage, {"another thread is stepping this Simulation"}, [&] { s.step(); });
  expect_error(ErrorKind::usage, {"another thread"}, [&] { s.take_events(); });
  s.interrupt();
  first.join();
  EXPECT_FALSE(arrived);
  const double time = s.time();
  EXPECT_TRUE(s.advance(1e-3));
  EXPECT_NEAR(s.time(), time + 1e-3, 1e-12);
}

TEST(Threads, AnInterruptBeforeCountsForTheNextAdvance) {
  Simulation s = box_simulation();
  s.interrupt();
  EXPECT_FALSE(s.advance(1.0));
  EXPECT_LT(s.time(), 0.1);
  EXPECT_TRUE(s.advance(0.01));
}

}  // namespace
}  // namespace embed
