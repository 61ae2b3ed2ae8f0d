// Forces and contacts between obstacles, soft or hard, and bodies.
#pragma once

#include <vector>

#include "sinew/contact/contact_finder.h"
#include "sinew/forces/obstacles.h"
#include "sinew/model/state.h"

namespace sinew {

// Points nearer than this to a hard obstacle are in contact with it [m]: a thousandth of the
// longest edge of the bodies' surfaces.
double contact_distance(const Model& model);

// By obstacle that is listed. Soft: as the positions are (forces/obstacles.h). Hard: the force is
// the mean over the last step, depth that of the deepest place inside, and places count that touch.
// `finder`: of the model; null if there are no contacts (sim/world.h).
std::vector<ObstacleReading> read_obstacles(const Model& model, const Controls& controls,
                                            const State& state, ContactFinder* finder);

}  // namespace sinew
