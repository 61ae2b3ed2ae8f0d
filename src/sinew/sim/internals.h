// Access to the World inside a Simulation, for higher rooms; not installed.
#pragma once

#include <sinew/simulation.h>

#include "sinew/sim/world.h"

namespace sinew::sim {

// The World of the simulation; Error(usage) if the simulation was moved from.
World& internals(Simulation& simulation);
const World& internals(const Simulation& simulation);

// From a parsed scene. Throws the errors of building it and of choosing its steps.
Simulation simulate(const Scene& scene, WorldOptions options = {});

}  // namespace sinew::sim
