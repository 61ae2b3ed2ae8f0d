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

// The readings of the listed obstacles, in their order. Soft obstacles: at the current positions
// (forces/obstacles.h). Hard obstacles: the mean force over the last step, the depth of the deepest
// contact, and the number of contacts. `finder`: of the model; null if there are no contacts
// (sim/world.h).
std::vector<ObstacleReading> read_obstacles(const Model& model, const Controls& controls,
                                            const State& state, ContactFinder* finder);

}  // namespace sinew
