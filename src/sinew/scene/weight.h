// Whether a body is stiff enough for its own weight.
#pragma once

#include <optional>
#include <string>

#include "sinew/scene/place.h"

namespace sinew {

// What a user should know about a body that its weight presses flat, or pulls out like dough: the
// pressure at its foot is p = density * gravity * height, and p / E the strain that this asks for.
// A warning from p = 5 E on, with a modulus that keeps it under a tenth as the remedy. None
// where every node is pinned, or where a law without Young's modulus is among the materials.
std::optional<std::string> weight_warning(const Scene& scene, const PlacedBody& placed);

}  // namespace sinew
