// The haptic loop: from the device to the tool, the force of the local contact, the observer of
// energy. It knows nothing of a Simulation. docs/haptics.md.
#pragma once

#include <sinew/haptics.h>

#include <cstdint>
#include <vector>

#include "sinew/haptics/local_contact.h"
#include "sinew/haptics/triple_buffer.h"

namespace sinew {

// Counts periods in bins of 10 us, the last one for all that are longer than 20 ms.
class PeriodCount {
 public:
  void add(double seconds);
  double percentile(double share) const;  // upper end of its bin [s]; 0: nothing counted
  double share_up_to(double seconds) const;
  double longest() const { return longest_; }
  std::int64_t count() const { return count_; }

 private:
  std::vector<std::int64_t> bins_ = std::vector<std::int64_t>(2001, 0);
  std::int64_t count_ = 0;
  double longest_ = 0.0;
};

// What the loop hands to the simulation, in the scene's frame.
struct LoopOutput {
  RigidPose tool;
  Wrench wrench;  // on the hand, about the handle
  bool button = false;
  std::int64_t ticks = 0;
  double peak_force = 0.0, path = 0.0, energy = 0.0, damped = 0.0;
};

class HapticLoop {
 public:
  HapticLoop(HapticDevice& device, const HapticsOptions& options);

  // Of the loop's thread.
  void tick(double dt);

  // Of the simulation's thread.
  void publish(const LocalContact& contact) { contacts_.write(contact); }
  const LoopOutput& latest() {
    outputs_.update();
    return outputs_.value();
  }

 private:
  Vec3 passive(const Vec3& force, const Vec3& way, double dt);

  HapticDevice& device_;
  HapticsOptions options_;
  Mat3 turn_;  // of the device's axes in the scene
  TripleBuffer<LocalContact> contacts_;
  TripleBuffer<LoopOutput> outputs_;

  LocalContact contact_;
  HapticInput input_;
  LoopOutput now_;
  bool started_ = false;
  Vec3 hand_ = Vec3::Zero();        // in the scene [m]
  Vec3 given_ = Vec3::Zero();       // force on the hand of the last tick [N]
  Vec3 difference_ = Vec3::Zero();  // of the last local contact to the newest one, dying out [N]
  double since_exchange_ = 0.0, exchange_ = 1e-3;  // [s]
  double taken_ = 0.0;                             // energy of the hand [J]
};

}  // namespace sinew
