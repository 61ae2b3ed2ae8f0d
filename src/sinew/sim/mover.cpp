#include "sinew/sim/mover.h"

#include <cmath>
#include <numbers>
#include <optional>

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

namespace {

// The pin that moves the nodes of an obstacle that is a mesh, index into Model::pins; none for
// others.
std::optional<std::size_t> pin_of(const Model& model, const Obstacle& obstacle) {
  if (obstacle.mesh() == nullptr) return std::nullopt;
  for (std::size_t p = 0; p < model.pins.size(); ++p) {
    const std::vector<Index>& nodes = model.pins[p].nodes;
    if (!nodes.empty() && nodes.front() == obstacle.nodes().begin) return p;
  }
  return std::nullopt;
}

}  // namespace

void let_pin_follow(Controls& controls, const Model& model, std::size_t obstacle) {
  if (const auto pin = pin_of(model, model.obstacles[obstacle]))
    controls.pin_paths[*pin] = controls.obstacle_paths[obstacle];
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
