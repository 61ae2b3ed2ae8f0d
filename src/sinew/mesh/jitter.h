// Irregular meshes from regular ones: what a patch test needs.
#pragma once

#include <array>

#include "sinew/mesh/tet_mesh.h"

namespace sinew {

// The largest share that nodes may be moved by.
constexpr double kMaxJitter = 0.45;

// Of what a tet has before, the volume that it has at least after the nodes have moved.
constexpr double kJitterKeepsVolume = 0.1;

// Moves every node of a grid (numbered like beam in shapes.h) by a random share, from -jitter to
// jitter, of the cell's edge along each axis; nodes on the grid's faces stay on them, on its edges
// and corners too. The sequence goes by node id: the same everywhere. Where a tet would keep less
// than kJitterKeepsVolume of its volume, its nodes are moved half as far, until none does.
// `cell` holds a cell's edges, in the nodes' unit; jitter [-] in [0, kMaxJitter]; 0 changes
// nothing.
void jitter_grid(TetMesh& mesh, const std::array<Index, 3>& cells, const Vec3& cell, double jitter);

}  // namespace sinew
