// Hard planes as half-spaces, for limits, inversion recovery and rest states. In contact, planes
// are obstacles like any other (contact/colliders.h). docs/methods/ground.md.
#pragma once

#include <variant>
#include <vector>

#include "sinew/model/controls.h"
#include "sinew/model/model.h"

namespace sinew {

struct HalfSpace {
  Vec3 point = Vec3::Zero();    // [m] on the plane
  Vec3 normal = Vec3::UnitY();  // [-] unit, towards the free side

  double height(const Vec3& x) const { return normal.dot(x - point); }  // [m]
};

// Calls f(half_space) for every hard plane, including the ground, with its pose at the time [s].
template <typename F>
void for_each_hard_plane(const Model& model, const Controls& controls, double time, const F& f) {
  for (std::size_t i = 0; i < model.obstacles.size(); ++i) {
    const Obstacle& o = model.obstacles[i];
    if (!o.hard() || !std::holds_alternative<shapes::Plane>(o.shape)) continue;
    const Pose pose = obstacle_pose(model, controls, static_cast<Index>(i), time);
    f(HalfSpace{pose.center, pose.turn.col(1)});
  }
}

// Lifts free nodes of bodies at x [m] (nodes) that are below a hard plane onto it. Limits call this
// between their sweeps, so that limits and planes both hold at the end. Returns the number of nodes
// that it lifted.
Index lift_onto_planes(const Model& model, const Controls& controls, double time,
                       std::vector<Vec3>& x);

}  // namespace sinew
