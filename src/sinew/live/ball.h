// The ball tool of the live view: an obstacle (forces/obstacles.h) that follows a pointer.
//
// It grows to its size within a tenth of a second and moves at a speed that tissue can follow: a
// ball that is put into the tissue, or jumps, pushes it aside and does not tear it.
#pragma once

#include <optional>

#include "sinew/live/frame.h"
#include "sinew/model/state.h"

namespace sinew::live {

class Ball {
 public:
  // From here on the ball is to be at `point` with this radius [m]. `size` of the whole body [m].
  void move(Model& model, State& state, const Vec3& point, double radius, double size);
  void remove(Model& model, State& state);

  // Called between frames: the way of the next one, of `interval` [s].
  void follow(Model& model, State& state, double interval);

  // Puts the ball into a model that has taken the place of the one before. stable_step: what an
  // explicit step may be [s], infinity: any. No node is pressed so hard that it would need a
  // shorter one.
  void hold(Model& model, State& state, double stable_step);

  bool is_there() const { return there_; }
  double radius() const { return wished_radius_; }
  std::optional<SphereStatus> status(const Model& model, const State& state) const;

 private:
  void put(Model& model, State& state, const Path& path, double radius);
  double pressure(const Model& model) const;

  bool there_ = false;
  Vec3 wished_ = Vec3::Zero();  // [m]
  double wished_radius_ = 0.0;  // [m]
  double size_ = 0.0;           // of the body [m]
  double stable_step_ = no_limit;
  Obstacle obstacle_;       // as it is in the model, its last obstacle
  KeyFrame before_, here_;  // where the last way began, and where this one does
};

}  // namespace sinew::live
