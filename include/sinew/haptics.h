// A haptic device that feels the tissue of a Simulation through a tool, one of its obstacles.
// docs/haptics.md.
#ifndef SINEW_HAPTICS_H
#define SINEW_HAPTICS_H

#include <sinew/export.h>
#include <sinew/simulation.h>
#include <sinew/types.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace sinew {

// What a device says of its handle.
struct HapticInput {
  Point position = {0.0, 0.0, 0.0};  // in the device's own frame [m]
  Quaternion rotation = {1.0, 0.0, 0.0, 0.0};
  bool button = false;
};

// A device, or what stands for one. The haptic loop calls read() and then write() once in a
// millisecond, from its own thread, and no other thread calls them meanwhile. Neither may wait,
// take a lock that others hold for long, or throw: a device that is lost keeps its last input.
// An input that is no number, beyond 1 km or without a rotation counts as the one before.
class SINEW_API HapticDevice {
 public:
  HapticDevice() = default;
  HapticDevice(const HapticDevice&) = delete;
  HapticDevice& operator=(const HapticDevice&) = delete;
  virtual ~HapticDevice();
  // `dt` [s]: since the last call.
  virtual HapticInput read(double dt) = 0;
  // The force on the hand and the torque about the handle's position, in the device's frame.
  virtual void write(const Wrench& wrench) = 0;
};

// A hand that holds the handle: a mass on a spring and a dashpot to where it wants to be.
struct HandDescription {
  double mass = 0.3;         // [kg]
  double damping = 4.0;      // [N s/m]
  double stiffness = 300.0;  // [N/m]
  // Where it wants to be at a time [m]. Called by the haptic loop.
  std::function<Point(double)> aim;
  Point start = {0.0, 0.0, 0.0};  // position at time 0, at rest [m]
};
class SINEW_API SimulatedHand : public HapticDevice {
 public:
  // Error(usage) for a mass that is not above 0, negative constants, or no aim.
  explicit SimulatedHand(HandDescription hand);
  HapticInput read(double dt) override;
  void write(const Wrench& wrench) override;
  // Of the loop's thread, or while it does not run.
  const Point& velocity() const { return velocity_; }  // [m/s]

 private:
  HandDescription hand_;
  Point position_, velocity_ = {0.0, 0.0, 0.0}, force_ = {0.0, 0.0, 0.0};
  double time_ = 0.0;
};

// A handle that follows a path, whatever the force. Before the first row and after the last one it
// stays there; between rows position and rotation are interpolated.
class SINEW_API RecordedPath : public HapticDevice {
 public:
  struct Row {
    double time = 0.0;  // [s], ascending
    HapticInput input;
  };
  // Error(usage) without rows, or if their times descend.
  explicit RecordedPath(std::vector<Row> rows);
  // CSV: time, x, y, z and, if given, qw, qx, qy, qz, button; lines that start with # and a line of
  // names are skipped. Error(io) if it cannot be read, Error(input) with file and line for a fault.
  static RecordedPath from_file(const std::filesystem::path& file);
  // The same for a text, `name` in messages.
  static RecordedPath from_text(std::string_view text, const std::string& name = "path");
  RecordedPath(RecordedPath&& other) noexcept;
  HapticInput read(double dt) override;
  void write(const Wrench& wrench) override;

 private:
  std::vector<Row> rows_;
  std::size_t at_ = 0;
  double time_ = 0.0;
};

struct HapticsOptions {
  // Of the spring between handle and tool [N/m]: the most that the hand can feel.
  double coupling = 2000.0;
  // Metres in the scene for a metre of the device; where the device's origin is in the scene [m],
  // and how its axes are turned there. Forces are turned back, not scaled.
  double scale = 1.0;
  Point origin = {0.0, 0.0, 0.0};
  Quaternion rotation = {1.0, 0.0, 0.0, 0.0};
  double max_force = 10.0;  // [N]; longer forces are shortened
  double friction = 0.3;    // Coulomb's, of the local contact between two exchanges
  // The observer of energy: what the loop gives to the hand and did not take from it before is
  // taken back by damping, of at most `max_damping` [N s/m].
  bool passive = true;
  double max_damping = 30.0;
};

// Of the loop since start().
struct HapticsStatistics {
  std::int64_t ticks = 0;
  double period_99_9 = 0.0, longest_period = 0.0;  // between two ticks [s]
  double in_time = 0.0;                            // share of periods up to 1.2 ms
  std::int64_t exchanges = 0;                      // with the simulation
  double peak_force = 0.0;                         // on the hand [N]
  double path = 0.0;                               // way of the tool [m]
  double energy = 0.0;    // taken from the hand so far, less what was given back [J]
  double damped = 0.0;    // of it, by the observer [J]
  bool priority = false;  // the loop's thread has a raised priority
};

// Two loops. The haptic loop has a thread of its own and a period of 1 ms: it reads the device,
// finds where the tool is against a local model of the contact, and writes the force. The
// simulation moves the tool there, and hands over the contact as it is then. Neither side waits for
// the other: both hand over through triple buffers.
//
// Not thread-safe: all functions belong to the thread of the simulation. The Simulation and the
// device must outlive it.
class SINEW_API Haptics {
 public:
  // The tool: a hard obstacle; a path of its own ends with the first advance(). Error(usage) for a
  // soft obstacle, or options that are not valid.
  Haptics(Simulation& simulation, ObstacleHandle tool, HapticDevice& device,
          const HapticsOptions& options = {});
  Haptics(Haptics&& other) noexcept;
  Haptics& operator=(Haptics&& other) noexcept;
  ~Haptics();  // stops the loop

  // Starts and stops the loop's thread. Both do nothing if it is so already.
  void start();
  void stop();
  // One tick of the loop by hand, for tests and hosts with a loop of their own; the thread must not
  // run. Returns the force on the hand [N], in the scene's frame.
  Wrench tick(double dt = 1e-3);

  // Moves the tool to where the loop has it, advances the simulation by `seconds`, and hands the
  // contact over. As Simulation::advance().
  bool advance(double seconds);
  // The same in real time until `seconds` have passed, the loop's thread running: `interval()` at a
  // time. Returns the simulated time over the real one: 1, or less if the simulation is too slow.
  double run(double seconds);
  // The simulated time between two exchanges in run() [s]: 1 ms where the whole simulation keeps up
  // with that, else 8 ms; and the reason, as a sentence.
  double interval() const;
  std::string reason() const;

  RigidPose tool() const;  // where the loop has it now
  Wrench force() const;    // the newest one on the hand, in the scene's frame
  bool button() const;
  HapticsStatistics statistics() const;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace sinew

#endif
