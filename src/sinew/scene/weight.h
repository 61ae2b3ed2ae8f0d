// A check whether a body is stiff enough for its own weight.
#pragma once

#include <optional>
#include <string>

#include "sinew/scene/place.h"

namespace sinew {

// A warning for a body that its weight flattens or stretches like dough. The pressure at its foot
// is p = density * gravity * height, and p / E the resulting strain. The warning is given for p >=
// 5 E, with a modulus that keeps the strain under a tenth as the remedy. None if every node is
// pinned, or if a law without Young's modulus is among the materials.
std::optional<std::string> weight_warning(const Scene& scene, const PlacedBody& placed);

}  // namespace sinew
