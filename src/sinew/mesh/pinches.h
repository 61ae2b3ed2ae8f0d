// Where the surface of a mesh touches itself.
#pragma once

#include <span>
#include <vector>

#include "sinew/base/vec.h"

namespace sinew {

// The edges that more than two of the triangles share, sorted.
std::vector<Edge> non_manifold_edges(std::span<const Triangle> triangles);

// The nodes whose triangles do not form one fan, sorted.
std::vector<Index> non_manifold_nodes(std::span<const Triangle> triangles);

}  // namespace sinew
