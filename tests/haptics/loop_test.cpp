#include "sinew/haptics/loop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>

namespace sinew {
namespace {

// A wall of `stiffness` in the half-space z < 0, as a simulation shows it that needs `delay` ms.
struct Wall {
  double stiffness = 5000.0;
  int delay = 10;

  LocalContact contact(double z) const {
    LocalContact c;
    c.at = Vec3(0.0, 0.0, z);
    c.force = Vec3(0.0, 0.0, stiffness * std::max(0.0, -z));
    c.gap = std::max(0.0, z);
    c.stiffness = 1.5 * stiffness;
    return c;
  }
  // Ticks for `seconds`; returns the largest way of the hand in the last tenth of them [m].
  template <typename Each>
  void run(HapticLoop& loop, double seconds, const Each& each) const {
    std::deque<double> z;
    loop.publish(contact(1.0));
    const int ticks = static_cast<int>(1e3 * seconds);
    for (int t = 0; t < ticks; ++t) {
      loop.tick(1e-3);
      z.push_back(loop.latest().tool.center[2]);
      if (static_cast<int>(z.size()) > delay) z.pop_front();
      if (t % delay == delay - 1) loop.publish(contact(z.front()));
      each(t);
    }
  }
};

HandDescription falling_hand(double damping) {
  HandDescription hand;
  hand.mass = 0.3;
  hand.damping = damping;
  hand.stiffness = 100.0;
  hand.start = {0.0, 0.0, 0.02};
  hand.aim = [](double) { return Point{0.0, 0.0, -0.04}; };
  return hand;
}

// A hand of 0.3 kg, almost without damping of its own, that pushes against 5 N/mm with a delay of
// 10 ms comes to rest.
TEST(HapticLoop, IsStableAgainstAStiffWallWithALateSimulation) {
  for (const double damping : {0.5, 4.0}) {
    SCOPED_TRACE(damping);
    SimulatedHand hand(falling_hand(damping));
    HapticsOptions options;
    options.coupling = 50e3;
    options.max_force = 50.0;
    HapticLoop loop(hand, options);
    double low = 1.0, high = -1.0, speed = 0.0;
    Wall().run(loop, 4.0, [&](int t) {
      if (t < 3000) return;
      low = std::min(low, loop.latest().tool.center[2]);
      high = std::max(high, loop.latest().tool.center[2]);
      speed = std::max(speed, std::abs(hand.velocity()[2]));
    });
    EXPECT_LT(high - low, 1e-5);
    EXPECT_LT(speed, 1e-3);
    // The force is that of the spring that pushes: 100 N/m over almost 40 mm.
    EXPECT_NEAR(loop.latest().wrench.force[2], 4.0, 0.1);
  }
}

// Without the observer, a late simulation and a local model that is far too soft or too stiff give
// energy until the hand flies off. Its speed at the end [m/s]:
TEST(HapticLoop, TheObserverKeepsWhatWouldBuzz) {
  Wall soft;
  const auto speed_of = [&](bool passive, double local) {
    SimulatedHand hand(falling_hand(0.2));
    HapticsOptions options;
    options.coupling = 50e3;
    options.max_force = 50.0;
    options.passive = passive;
    HapticLoop loop(hand, options);
    std::deque<double> z;
    double speed = 0.0;
    for (int t = 0; t < 4000; ++t) {
      loop.tick(1e-3);
      z.push_back(loop.latest().tool.center[2]);
      if (z.size() > 10) z.pop_front();
      if (t % 10 == 9) {
        LocalContact c = soft.contact(z.front());
        c.stiffness = local;
        loop.publish(c);
      }
      if (t > 3000) speed = std::max(speed, std::abs(hand.velocity()[2]));
    }
    return speed;
  };
  for (const double local : {2000.0, 3000.0, 20e3}) {
    EXPECT_GT(speed_of(false, local), 1.0) << local;
    EXPECT_LT(speed_of(true, local), 0.01) << local;
  }
}

TEST(HapticLoop, FollowsTheDevicesFrame) {
  std::vector<RecordedPath::Row> rows = {{0.0, {}}, {1.0, {{0.1, 0.0, 0.0}, {1, 0, 0, 0}, true}}};
  RecordedPath path(rows);
  HapticsOptions options;
  options.scale = 2.0;
  options.origin = {1.0, 2.0, 3.0};
  options.rotation = {std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)};  // x to y
  HapticLoop loop(path, options);
  for (int t = 0; t < 1000; ++t) loop.tick(1e-3);
  const Point at = loop.latest().tool.center;
  EXPECT_NEAR(at[0], 1.0, 1e-9);
  EXPECT_NEAR(at[1], 2.2, 1e-3);
  EXPECT_NEAR(at[2], 3.0, 1e-9);
  EXPECT_NEAR(loop.latest().path, 0.2, 1e-3);
}

// A driver with a fault does not throw the hand.
TEST(HapticLoop, AnInputThatIsNoNumberCountsAsTheOneBefore) {
  class Faulty final : public HapticDevice {
   public:
    HapticInput read(double) override {
      const double x = ++ticks_ % 2 == 0 ? std::nan("") : 0.01;
      return {{x, 0.0, 0.0}, {ticks_ % 3 == 0 ? 0.0 : 1.0, 0.0, 0.0, 0.0}, false};
    }
    void write(const Wrench& wrench) override {
      for (const double f : wrench.force) EXPECT_TRUE(std::isfinite(f));
    }

   private:
    int ticks_ = 0;
  };
  Faulty device;
  HapticLoop loop(device, {});
  for (int t = 0; t < 20; ++t) loop.tick(1e-3);
  EXPECT_EQ(loop.latest().tool.center[0], 0.01);
}

TEST(PeriodCount, Percentiles) {
  PeriodCount count;
  for (int i = 0; i < 999; ++i) count.add(1.004e-3);
  count.add(0.05);
  EXPECT_NEAR(count.percentile(0.5), 1.01e-3, 1e-9);
  EXPECT_NEAR(count.share_up_to(1.2e-3), 0.999, 1e-9);
  EXPECT_EQ(count.longest(), 0.05);
  EXPECT_EQ(count.percentile(1.0), 0.05);
}

}  // namespace
}  // namespace sinew
