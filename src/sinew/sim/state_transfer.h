// What a state keeps when another model of the same bodies takes the place of its own.
#pragma once

#include <string>

#include "sinew/model/controls.h"
#include "sinew/model/state.h"

namespace sinew {

// The state as it goes on with `after`, whose bodies, pins and attachments have the same nodes.
// Obstacles may have come or gone; the one named `replaced` starts anew. Contacts start cold.
// `controls`: of `after`.
State transfer_state(const Model& before, const State& old, const Model& after,
                     const Controls& controls, const std::string& replaced);

// Takes from every body that becomes softer, by a ratio r < 1 of its mean shear modulus, the share
// sqrt(r) of the speeds at which it deforms; how it moves and turns as a whole stays. A deformed
// body that is made a million times stiffer swings at a thousand times the speed, and soft again it
// would be torn apart by it: this way its swings keep their size. Models with the same nodes.
void calm_softened_bodies(const Model& before, const Model& after, State& state);

// Null if there is none of that name.
const Obstacle* obstacle_named(const Model& model, const std::string& name);

}  // namespace sinew
