// The values that a hand, a tool or a slider changes during a run. A step reads them and never
// writes them; between steps their owner may change any of them.
#pragma once

#include <vector>

#include "sinew/base/vec.h"
#include "sinew/model/model.h"
#include "sinew/model/obstacle.h"
#include "sinew/model/path.h"

namespace sinew {

// Springs of rest length zero that pull nodes to points, for example a hand that holds a patch of
// tissue (forces/grabs.h).
struct Grab {
  std::vector<Index> nodes;
  std::vector<double> stiffness;  // [N/m] >= 0 (nodes)
  std::vector<Vec3> offset;       // of each node's target, relative to `target` [m] (nodes)
  Vec3 target = Vec3::Zero();     // [m]
};

// A sphere that presses as a soft obstacle does (forces/obstacles.h). It belongs to the owner of
// the run, not to the scene. Example: the ball of the live view.
struct Tool {
  Vec3 center = Vec3::Zero();  // [m], before its path moves it
  double radius = 0.0;         // [m]
  double stiffness = 0.0;      // [N/m3] pressure per depth > 0
  Path path = {};
};

// Made by initial_controls() alone, so that every pin and obstacle of the Model has a path.
struct Controls {
  Vec3 gravity = Vec3::Zero();       // [m/s2]
  std::vector<Path> pin_paths;       // (Model::pins)
  std::vector<Path> obstacle_paths;  // (Model::obstacles); the pin of a mesh has the same
  std::vector<Tool> tools;
  std::vector<Grab> grabs;

 private:
  Controls() = default;
  friend Controls initial_controls(const Model& model);
};

// The Model's gravity and paths; no tools and no grabs.
Controls initial_controls(const Model& model);

// The pose of an obstacle of the Model at a time [s].
Pose obstacle_pose(const Model& model, const Controls& controls, Index obstacle, double time);

// Whether f(path) holds for the path of any pin, obstacle or tool.
template <typename F>
bool any_path(const Controls& controls, const F& f) {
  for (const Path& path : controls.pin_paths)
    if (f(path)) return true;
  for (const Path& path : controls.obstacle_paths)
    if (f(path)) return true;
  for (const Tool& tool : controls.tools)
    if (f(tool.path)) return true;
  return false;
}

}  // namespace sinew
