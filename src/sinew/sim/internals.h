// The inside of a Simulation, for the rooms above: not installed.
#pragma once

#include <sinew/simulation.h>

#include "sinew/sim/world.h"

namespace sinew::sim {

// Of a Simulation that was not moved from; Error(usage) otherwise.
World& internals(Simulation& simulation);
const World& internals(const Simulation& simulation);

// From a scene that has been parsed. Throws what building it and choosing its steps throw.
Simulation simulate(const Scene& scene, WorldOptions options = {});

}  // namespace sinew::sim
