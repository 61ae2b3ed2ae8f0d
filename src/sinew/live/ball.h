// The ball tool of the live view: a tool (model/controls.h) that follows a pointer.
//
// It grows to its size within a tenth of a second and moves at a speed that tissue can follow, so a
// ball that appears inside the tissue, or jumps, pushes it aside and does not tear it.
#pragma once

#include <optional>

#include "sinew/live/frame.h"
#include "sinew/sim/world.h"

namespace sinew::live {

class Ball {
 public:
  // Sets the target position and radius [m]; adds the ball if there is none.
  void move(sim::World& world, const Vec3& point, double radius);
  void remove(sim::World& world);

  // Moves the ball over the next frame of `interval` [s]; called between frames. `size` of the
  // whole body [m].
  void follow(sim::World& world, double interval, double size);

  // Updates the stiffness for a new model.
  void hold(sim::World& world);

  // The same ball in a world that has taken over the state of its own.
  Ball in(const sim::World& world) const;

  bool is_there() const { return tool_.has_value(); }
  double radius() const { return wished_radius_; }
  std::optional<SphereStatus> status(const sim::World& world) const;

 private:
  double stiffness_for(const sim::World& world) const;

  std::optional<sim::ToolHandle> tool_;  // none: there is no ball
  Vec3 wished_ = Vec3::Zero();           // target [m]
  double wished_radius_ = 0.0;           // target [m]
  double stiffness_ = 0.0;               // [N/m3]
};

}  // namespace sinew::live
