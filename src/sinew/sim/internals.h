// The inside of a Simulation, for the rooms above: not installed.
#pragma once

#include <sinew/simulation.h>

#include "sinew/sim/world.h"

namespace sinew::sim {

// Of a Simulation that was not moved from; Error(usage) otherwise.
World& internals(Simulation& simulation);
const World& internals(const Simulation& simulation);

// From a scene that has been parsed, such as run/ and live/ hold.
Simulation simulate(const Scene& scene, int threads = 0);

}  // namespace sinew::sim
