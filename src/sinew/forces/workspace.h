// Scratch of a run: holds nothing that the next step could not compute again.
#pragma once

#include <vector>

#include "sinew/base/vec.h"
#include "sinew/model/model.h"

namespace sinew {

struct Workspace {
  explicit Workspace(const Model& model);

  std::vector<Vec3> spring_force;  // on end 0 of each spring [N] (springs)
  std::vector<Vec3> force;         // total on each node [N] (nodes)
  std::vector<double> partial;     // sums of blocks, whatever they are of
};

}  // namespace sinew
