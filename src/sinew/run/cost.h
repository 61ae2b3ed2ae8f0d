// The wall time that a run will take, before it starts.
#pragma once

#include <optional>
#include <string>

#include "sinew/sim/world.h"

namespace sinew {

// Wall time that the rest of a run takes [s], from the count of its steps and one measured
// evaluation of the forces; 0 for rest states. Contacts, output and steps that get shorter
// come on top.
double estimate_cost(sim::World& world);

// A sentence with the estimate, its reason and the remedy, if it is more than a day; or more than
// a second because of one bad tet (scene/short_step.h).
std::optional<std::string> cost_warning(sim::World& world);

}  // namespace sinew
