// Double nodes: nodes that lie on others, so that parts of a mesh are not joined there.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "sinew/base/vec.h"

namespace sinew {

// Nodes nearer than this share of the bounding box's diagonal are double, unless a tet has both.
inline constexpr double kDouble = 1e-6;

// Pairs (node, earlier node) for each node that lies on an earlier one, ascending. Nodes that no
// tet names are left out. Ids must be in range, coordinates finite.
std::vector<std::pair<Index, Index>> find_doubles(std::span<const Vec3> nodes,
                                                  std::span<const Tet> tets);

}  // namespace sinew
