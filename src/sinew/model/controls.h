// The values that a hand, a tool or a slider changes during a run. A step reads them and never
// writes them; between steps their owner may change any of them.
#pragma once

#include <vector>

#include "sinew/base/vec.h"
#include "sinew/model/model.h"

namespace sinew {

// Springs of rest length zero that pull nodes to points, for example a hand that holds a patch of
// tissue (forces/grabs.h).
struct Grab {
  std::vector<Index> nodes;
  std::vector<double> stiffness;  // [N/m] >= 0 (nodes)
  std::vector<Vec3> offset;       // of each node's target, relative to `target` [m] (nodes)
  Vec3 target = Vec3::Zero();     // [m]
};

struct Controls {
  Vec3 gravity = Vec3::Zero();  // [m/s2]
  std::vector<Grab> grabs;
};

// The Model's gravity and no grabs.
inline Controls initial_controls(const Model& model) {
  return {model.start_gravity, {}};
}

}  // namespace sinew
