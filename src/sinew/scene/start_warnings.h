// What is wrong with the start of a run: bodies inside obstacles or each other, pins that jump.
#pragma once

#include <string>
#include <vector>

#include "sinew/model/model.h"
#include "sinew/scene/scene.h"

namespace sinew {

// A sentence for each fault, for the user before the run: bodies that start inside an obstacle or
// below the ground, bodies that overlap or coincide, pins that move faster than waves run through
// their body. `model`: finished, of the scene.
std::vector<std::string> start_warnings(const Scene& scene, const Model& model);

}  // namespace sinew
