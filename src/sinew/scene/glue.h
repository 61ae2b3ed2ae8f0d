// Glue: nodes of one body tied to the places of another's surface that they are nearest to.
// docs/methods/ties.md.
#pragma once

#include <limits>
#include <vector>

#include "sinew/model/model.h"
#include "sinew/scene/place.h"

namespace sinew {

// What was found around the nodes to be glued.
struct Surroundings {
  Index triangles = 0;  // of the other body's surface, all three nodes of which are targets
  Index tied = 0;       // nodes
  double nearest = std::numeric_limits<double>::infinity();  // [m] of a node to a triangle
};

// Ties each of `nodes` that is at most `within` [m] from a triangle of the surface of `to` whose
// nodes are all among `targets` to its place in the tet behind the nearest one. stiffness [N/m] of
// each tie; 0: ten times what the network and the springs of the node resist with, or of the
// triangle's nodes where that is less.
Surroundings glue_nodes(Model& model, const std::vector<Index>& nodes, const PlacedBody& to,
                        const std::vector<Index>& targets, double within, double stiffness);

}  // namespace sinew
