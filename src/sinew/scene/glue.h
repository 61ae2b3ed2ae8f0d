// Glue: ties nodes of one body to the nearest points of another body's surface.
// docs/methods/ties.md.
#pragma once

#include <limits>
#include <vector>

#include "sinew/model/model.h"
#include "sinew/scene/place.h"

namespace sinew {

// Result of the search around the nodes to be glued.
struct Surroundings {
  Index triangles = 0;  // of the other body's surface whose three nodes are all targets
  Index tied = 0;       // nodes
  double nearest = std::numeric_limits<double>::infinity();  // [m] of a node to a triangle
};

// Ties nodes to the tets behind the nearest triangles: each of `nodes` within `within` [m] of the
// surface of `to`, of which only triangles whose nodes are all among `targets` count. stiffness
// [N/m] of each tie; 0: ten times the stiffness of the node's network and springs, or of the
// triangle's nodes if that is less.
Surroundings glue_nodes(Model& model, const std::vector<Index>& nodes, const PlacedBody& to,
                        const std::vector<Index>& targets, double within, double stiffness);

}  // namespace sinew
