// Opens a mesh along faces: the nodes on them are doubled where the faces separate their tets.
#pragma once

#include <span>
#include <vector>

#include "sinew/cut/patch.h"

namespace sinew {

// Another node at the place of `node`, for some of its tets.
struct NodeCopy {
  Index node = -1;          // the one that is copied
  Index copy = -1;          // its number
  std::vector<Index> tets;  // of the patch, ascending
};

// At each node of a face, the tets that share a face which is not opened stay together; each group
// but the one of the largest volume gets a copy of the node. A node at the front of the cut has one
// group and is not copied. Copies are numbered from patch.node_count() in the order of their nodes,
// and at one node of their lowest tets. `faces`: sorted nodes, ascending. `volume`: of the tets of
// the patch, in any unit. The patch must hold all tets of the nodes of the faces.
std::vector<NodeCopy> open_faces(const Patch& patch, std::span<const Triangle> faces,
                                 std::span<const double> volume);

// The tets of the patch with the copies.
std::vector<Tet> opened_tets(const Patch& patch, std::span<const NodeCopy> copies);

// The nodes at which the surface would touch itself, in the node or along an edge, if the faces
// were opened, and does not yet: ascending.
std::vector<Index> pinched_nodes(const Patch& patch, std::span<const Triangle> faces,
                                 std::span<const double> volume);

// The faces without those at pinched nodes, before which the cut then ends, and without those that
// would not open. `faces` and the result: sorted nodes, ascending.
std::vector<Triangle> opening_faces(const Patch& patch, std::vector<Triangle> faces,
                                    std::span<const double> volume);

// The faces with every piece that is cut off, but is smaller than `least` (tets of the patch), left
// attached to its larger neighbour: a blade that comes by twice would leave crumbs of single tets.
// rest: X [m] (nodes). inside: whether all neighbours of the tet are in the patch (its tets).
std::vector<Triangle> without_crumbs(const Patch& patch, std::vector<Triangle> faces,
                                     std::span<const Vec3> rest, std::span<const double> volume,
                                     std::span<const char> inside, std::span<const double> least);

}  // namespace sinew
