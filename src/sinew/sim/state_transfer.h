// The parts of a state that stay when another model of the same bodies replaces its own.
#pragma once

#include <string>

#include "sinew/model/controls.h"
#include "sinew/model/state.h"

namespace sinew {

// The state for `after`, whose bodies, pins and attachments have the same nodes. Obstacles may have
// been added or removed; the one named `replaced` is initialised again. Contacts have no warm
// start. `controls`: of `after`.
State transfer_state(const Model& before, const State& old, const Model& after,
                     const Controls& controls, const std::string& replaced);

// Reduces the deformation speeds of every body that becomes softer, by the factor sqrt(r), with r
// the ratio of its mean shear moduli, below 1. Its rigid motion does not change. The amplitude of
// its vibration is then the same: a deformed body made a million times stiffer vibrates at a
// thousand times the speed, and would be torn apart at that speed when it is soft again. The models
// have the same nodes.
void damp_softened_bodies(const Model& before, const Model& after, State& state);

// Null if there is no obstacle of that name.
const Obstacle* obstacle_named(const Model& model, const std::string& name);

}  // namespace sinew
