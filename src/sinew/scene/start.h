// Start positions of a body's nodes other than the rest positions.
#pragma once

#include <vector>

#include "sinew/scene/place.h"

namespace sinew {

// Positions [m] (nodes of the body) by the word of SceneBody::start, from the body as it is placed,
// with the bounding box of its nodes and the box's thinnest axis, the first of equals:
//   rest      empty: where the body is placed
//   flat      all nodes in the box's mid plane across the thinnest axis
//   inverted  mirrored in that plane: every tet inside out
//   random    anywhere in the box, always the same
std::vector<Vec3> start_positions(const PlacedBody& placed);

}  // namespace sinew
