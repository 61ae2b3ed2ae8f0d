// What obstacles and bodies do to each other, soft obstacles and hard ones.
#pragma once

#include <vector>

#include "sinew/forces/obstacles.h"
#include "sinew/forces/workspace.h"
#include "sinew/model/state.h"

namespace sinew {

// By obstacle that is listed. Soft: as the positions are (forces/obstacles.h). Hard: the force is
// the mean over the last step, depth that of the deepest place inside, and places count as touching
// that are inside or nearer than a thousandth of the longest edge of the bodies' surfaces.
std::vector<ObstacleReading> read_obstacles(const Model& model, const State& state,
                                            Workspace& workspace);

}  // namespace sinew
