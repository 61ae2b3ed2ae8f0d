// Irregular meshes from regular ones, for patch tests.
#pragma once

#include <array>

#include "sinew/mesh/tet_mesh.h"

namespace sinew {

// The largest share of a cell's edge by which nodes may move.
constexpr double kMaxJitter = 0.45;

// The smallest volume of a tet after the nodes have moved, as a share of its volume before.
constexpr double kJitterKeepsVolume = 0.1;

// Moves every node of a grid (numbered like beam in shapes.h) by a random share, from -jitter to
// jitter, of the cell's edge along each axis. Nodes on the grid's faces, edges and corners stay on
// them. The random sequence is indexed by node id, so it is the same everywhere. If a tet would
// keep less than kJitterKeepsVolume of its volume, its nodes are moved half as far, until none
// does. `cell` holds a cell's edges, in the nodes' unit; jitter [-] in [0, kMaxJitter]; 0 changes
// nothing.
void jitter_grid(TetMesh& mesh, const std::array<Index, 3>& cells, const Vec3& cell, double jitter);

}  // namespace sinew
