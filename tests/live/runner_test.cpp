#include "sinew/live/runner.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "sinew/base/cancel.h"
#include "tests/live/support.h"

namespace sinew::live {
namespace {

using namespace std::chrono_literals;

// Waits until the condition holds; a minute is never needed, but for a machine that stands still.
template <typename Condition>
bool soon(const Condition& condition) {
  const auto end = std::chrono::steady_clock::now() + 60s;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(1ms);
  }
  return true;
}

TEST(Runner, StandsStillUntilItIsToldToPlayAndAgainAfterwards) {
  std::atomic<int> published{0};
  Runner runner(test::hanging_box(), [&] { ++published; });
  EXPECT_EQ(runner.snapshot().frame->number, 1u);
  EXPECT_EQ(runner.snapshot().status->time, 0.0);
  ASSERT_TRUE(runner.post(Play{true}));
  EXPECT_TRUE(soon([&] { return runner.snapshot().frame->time > 0.05; }));
  ASSERT_TRUE(runner.post(Play{false}));
  EXPECT_TRUE(soon([&] { return !runner.snapshot().status->running; }));
  const double time = runner.snapshot().frame->time;
  std::this_thread::sleep_for(20ms);
  EXPECT_EQ(runner.snapshot().frame->time, time);
  EXPECT_GE(published.load(), 4);
}

TEST(Runner, ItsRateIsThatOfTheClock) {
  Runner runner(test::hanging_box());
  runner.post(SetTimeScale{0.5});
  runner.post(Play{true});
  EXPECT_TRUE(soon([&] { return runner.snapshot().status->rate > 0.0; }));
  EXPECT_LT(runner.snapshot().status->rate, 0.6);
}

TEST(Runner, ErrorsOfCommandsAreInTheStatus) {
  Runner runner(test::hanging_box());
  runner.post(SetMaterial{"", "", "young", "-1"});
  EXPECT_TRUE(soon([&] { return runner.snapshot().status->errors == 1; }));
  EXPECT_NE(runner.snapshot().status->error.find("young"), std::string::npos);
  runner.post(SetMaterial{"", "", "young", "1e4"});
  EXPECT_TRUE(soon([&] { return runner.snapshot().status->error.empty(); }));
}

TEST(Runner, AFloodOfCommandsIsBoundedAndMovesOfOneHandAreOne) {
  Runner runner(test::hanging_box());
  runner.post(Grab{0, 0, Vec3::Zero(), 0.0});
  for (int i = 0; i < 100000; ++i) {
    ASSERT_TRUE(runner.post(Drag{0, Vec3(1e-6 * i, 0, 0)}));
  }
  EXPECT_TRUE(soon([&] {
    const auto status = runner.snapshot().status;
    return !status->hands.empty() && status->hands[0].target.x() > 0.099;
  }));
  int dropped = 0;
  for (int i = 0; i < 20000; ++i) {
    dropped += runner.post(Play{i % 2 == 0}) ? 0 : 1;
    dropped += runner.post(SetTimeScale{1.0}) ? 0 : 1;
  }
  EXPECT_TRUE(soon([&] { return runner.post(Play{false}); }));
  SUCCEED() << dropped << " dropped";
}

// A scene that opens when `go` is set, or is cancelled.
Open slow_scene(const std::atomic<bool>& go) {
  return {[&go] {
    while (!go) stop_if_cancelled();
    return test::hanging_box({"box.young=3e4"});
  }};
}

TEST(Runner, TheSceneBeforeRunsOnWhileAnotherIsOpened) {
  Runner runner(test::hanging_box());
  std::atomic<bool> go{false};
  runner.post(Play{true});
  runner.post(slow_scene(go));
  runner.post(SetMaterial{"", "", "poisson", "0.3"});  // of the new scene
  const double time = runner.snapshot().frame->time;
  EXPECT_TRUE(soon([&] { return runner.snapshot().frame->time > time + 0.05; }));
  EXPECT_EQ(runner.snapshot().parameters->parts[0].material.poisson, 0.45);
  go = true;
  EXPECT_TRUE(soon([&] { return runner.snapshot().parameters->parts[0].material.young == 3e4; }));
  EXPECT_TRUE(soon([&] { return runner.snapshot().parameters->parts[0].material.poisson == 0.3; }));
  EXPECT_FALSE(runner.snapshot().status->running);
}

TEST(Runner, AnOpeningCanBeCancelled) {
  Runner runner(test::hanging_box());
  const std::atomic<bool> never{false};
  runner.post(Play{true});
  runner.post(slow_scene(never));
  EXPECT_TRUE(soon([&] { return runner.snapshot().frame->time > 0.05; }));
  runner.post(Cancel{});
  EXPECT_TRUE(soon([&] { return runner.snapshot().status->errors == 1; }));
  EXPECT_NE(runner.snapshot().status->error.find("the opening was cancelled"), std::string::npos);
  EXPECT_TRUE(runner.snapshot().status->running);
  const double time = runner.snapshot().frame->time;
  EXPECT_TRUE(soon([&] { return runner.snapshot().frame->time > time; }));
}

TEST(Runner, AnotherSceneTakesThePlaceOfOneThatIsBeingOpened) {
  Runner runner(test::hanging_box());
  const std::atomic<bool> never{false}, now{true};
  runner.post(slow_scene(never));
  std::this_thread::sleep_for(5ms);
  runner.post(slow_scene(now));
  EXPECT_TRUE(soon([&] { return runner.snapshot().parameters->parts[0].material.young == 3e4; }));
  EXPECT_EQ(runner.snapshot().status->errors, 0u);
}

TEST(Runner, EndsWhileASceneIsBeingOpened) {
  const std::atomic<bool> never{false};
  Runner runner(test::hanging_box());
  runner.post(slow_scene(never));
  std::this_thread::sleep_for(5ms);
}

TEST(Runner, EndsInTheMiddleOfSlowFrames) {
  Runner runner(test::hanging_box({"box.young=1e9"}));
  runner.post(Play{true});
  EXPECT_TRUE(soon([&] { return runner.snapshot().frame->number > 3; }));
}

TEST(Runner, ManyReadersSeeWholeFrames) {
  Runner runner(test::hanging_box());
  runner.post(Play{true});
  std::vector<std::thread> readers;
  std::atomic<int> torn{0};
  for (int r = 0; r < 3; ++r) {
    readers.emplace_back([&] {
      std::uint64_t last = 0;
      for (int i = 0; i < 300; ++i) {
        const Snapshot s = runner.snapshot();
        torn += s.frame->position.size() != 3 * s.topology->node.size() ? 1 : 0;
        torn += s.frame->number < last ? 1 : 0;
        last = s.frame->number;
        std::this_thread::sleep_for(100us);
      }
    });
  }
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(torn.load(), 0);
}

}  // namespace
}  // namespace sinew::live
