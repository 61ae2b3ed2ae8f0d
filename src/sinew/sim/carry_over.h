// What a state keeps when the material under it changes.
#pragma once

#include "sinew/model/state.h"

namespace sinew {

// Takes from every body that becomes softer, by a ratio r < 1 of its mean shear modulus, the share
// sqrt(r) of the speeds at which it deforms; how it moves and turns as a whole stays. A deformed
// body that is made a million times stiffer swings at a thousand times the speed, and soft again it
// would be torn apart by it: this way its swings keep their size. Models with the same nodes.
void calm_softened_bodies(const Model& before, const Model& after, State& state);

}  // namespace sinew
