// The nodes of a selection.
#pragma once

#include <string>
#include <vector>

#include "sinew/scene/place.h"

namespace sinew {

// Node ids of the body's mesh, ascending; at least one. `what` names the selection in messages:
// "'select' of [pin.end]". A point on a boundary counts as inside, within 1e-9 of the body's
// diagonal. `nearest` chooses from the nodes that meet every other condition.
// Error(input) if no node meets the conditions, or a label or node id is not in the mesh.
std::vector<Index> select_nodes(const PlacedBody& body, const Selection& select,
                                const std::string& what);

// Whether a point lies in the selection's box, sphere and half-space, as far as it has them.
// tolerance [m]: what counts as inside.
bool in_places(const Selection& select, const Vec3& x, double tolerance);

}  // namespace sinew
