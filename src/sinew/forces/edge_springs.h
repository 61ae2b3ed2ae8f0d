// The share of single tets in the network, as springs of rest length zero along the edges, for
// PackedLayout: within edge cells no list of the network's springs is needed.
#pragma once

#include <vector>

#include "sinew/model/model.h"

namespace sinew {

// Those of the tets of an edge cell act with the cell, between the ends of its edge. Where the tets
// around an edge are in no edge cell (beta = 1), they act on the bare edge.
struct EdgeSprings {
  std::vector<double> stiffness;  // k [N/m] (edge cells, then bare edges)
  std::vector<Edge> bare;         // node ids

  Index count() const { return static_cast<Index>(stiffness.size()); }
};

// k_ij = -sum_t mu_t V_t G_i . G_j over the tets t around the edge, mu_t the model's tet_shear.
EdgeSprings find_edge_springs(const Model& model);

}  // namespace sinew
