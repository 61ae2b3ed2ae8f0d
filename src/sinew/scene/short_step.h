// The cost of explicit steps on a mesh with bad tets, before the run.
#pragma once

#include <optional>
#include <string>

#include "sinew/scene/place.h"

namespace sinew {

// One line if the body's worst tet makes explicit steps much shorter than its other tets do: names
// the tet, its radius ratio, the steps, the number of them, the wall time, and the remedy. Nothing
// for steps of another kind, and if the run is short anyway.
std::optional<std::string> step_warning(const Scene& scene, const PlacedBody& placed);

}  // namespace sinew
