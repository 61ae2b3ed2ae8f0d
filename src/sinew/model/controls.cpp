#include "sinew/model/controls.h"

namespace sinew {

Controls initial_controls(const Model& model) {
  Controls controls;
  controls.gravity = model.start_gravity;
  for (const Pin& pin : model.pins) controls.pin_paths.push_back(pin.path);
  for (const Obstacle& o : model.obstacles) controls.obstacle_paths.push_back(o.path);
  return controls;
}

Pose obstacle_pose(const Model& model, const Controls& controls, Index obstacle, double time) {
  const Obstacle& o = model.obstacles[uz(obstacle)];
  const Path& path = controls.obstacle_paths[uz(obstacle)];
  return {path.at(time, o.center), path.rotation(time) * o.rotation};
}

}  // namespace sinew
