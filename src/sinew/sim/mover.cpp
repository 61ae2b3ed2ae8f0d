#include "sinew/sim/mover.h"

#include <cmath>
#include <numbers>

namespace sinew::sim {

Vec3 rotation_vector(const Mat3& rotation, const Vec3& near) {
  const Eigen::AngleAxisd turn(rotation);
  const double full = 2.0 * std::numbers::pi;
  Vec3 axis = turn.axis();
  if (turn.angle() == 0.0) {
    if (near.norm() < 0.5 * full) return Vec3::Zero();
    axis = near.normalized();
  }
  return (turn.angle() + full * std::round((near.dot(axis) - turn.angle()) / full)) * axis;
}

Pin* pin_of(Model& model, const Obstacle& obstacle) {
  if (obstacle.mesh() == nullptr) return nullptr;
  for (Pin& pin : model.pins)
    if (!pin.nodes.empty() && pin.nodes.front() == obstacle.nodes().begin) return &pin;
  return nullptr;
}

void lead_path(Path& path, const Vec3& pivot, const KeyFrame& to, double last_step, double start,
               double end) {
  // The same motion about the new pivot.
  const auto motion_at = [&](double time) {
    KeyFrame key = path.frame(time);
    key.time = time;
    key.move = path.at(time, pivot) - pivot;
    return key;
  };
  const double before = start - last_step;
  const KeyFrame past = motion_at(before);
  const KeyFrame here = motion_at(start);
  KeyFrame there = to;
  there.time = end;
  path.keys.clear();
  if (before > 0.0 && before < start) path.keys.push_back(past);
  path.keys.push_back(here);
  path.keys.push_back(there);
  path.pivot = pivot;
  path.smooth = false;
}

}  // namespace sinew::sim
