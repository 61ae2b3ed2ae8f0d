// Bodies that are inside each other: checks contacts in tests and at the start of a run.
#pragma once

#include <vector>

#include "sinew/model/model.h"

namespace sinew {

// Nodes on the surface of body a that are inside tets of body b.
struct Overlap {
  Index a = 0;
  Index b = 0;
  Index nodes = 0;     // the number of them
  Index deepest = -1;  // the node that is deepest inside
  double depth = 0.0;  // its distance from the surface of b [m]
};

// All pairs of different bodies that overlap at positions x [m] (nodes), by a, then b; needs
// Model::surface. `tolerance` [m]: nodes at a smaller depth do not count. Rigid meshes are not
// tested.
std::vector<Overlap> find_overlaps(const Model& model, const std::vector<Vec3>& x,
                                   double tolerance = 0.0);

}  // namespace sinew
