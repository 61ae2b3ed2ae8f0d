// The region that each tet of a body is in.
#pragma once

#include <vector>

#include "sinew/scene/place.h"

namespace sinew {

// Index into the body's regions (tets); -1: none of them. A region has the tets with its labels, or
// those whose centroid lies in the box, sphere and half-space of its selection; a centroid on the
// boundary counts as inside, within 1e-9 of the body's diagonal.
// Error(input) for a label that the mesh does not have, a selection without a tet, a tet in two
// regions.
std::vector<int> regions_of_tets(const PlacedBody& placed);

}  // namespace sinew
