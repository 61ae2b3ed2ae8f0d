// The contact surface: the surfaces of the bodies and of rigid meshes, in one list.
// contact/contact_surface.h builds it once; contact/surfaces.h finds contacts on it.
#pragma once

#include <array>
#include <vector>

#include "sinew/base/vec.h"

namespace sinew {

// Nodes and triangles are stored owner by owner. An owner is a body, a piece of a body that was
// cut, or a rigid mesh. Lengths are those of the rest shape.
struct ContactSurface {
  std::vector<Index> nodes;           // node ids, ascending (nodes)
  std::vector<double> node_size;      // mean size of the triangles around it [m] (nodes)
  std::vector<Index> ring_start;      // offsets into ring (nodes + 1)
  std::vector<Index> ring;            // triangles around the node, ascending
  std::vector<Triangle> triangles;    // node ids, counter-clockwise from outside (triangles)
  std::vector<double> triangle_size;  // the smaller of the mean edge and the height of the tet
                                      // behind it [m] (triangles)
  std::vector<Edge> edges;            // node ids (edges), owner by owner
  std::vector<std::array<Index, 2>> edge_triangles;  // on both sides (edges); second -1: none;
                                                     // -2: more than one
  std::vector<double> edge_bend;   // [rad] (edges) between the triangles' normals: > 0 convex, 0
                                   // without exactly two triangles
  std::vector<Range> owner_nodes;  // ranges of `nodes` (owners)
  std::vector<Range> owner_triangles;  // of `triangles` (owners)
  std::vector<Range> owner_edges;      // of `edges` (owners)
  std::vector<Range> body_owners;      // owners: one, or the pieces after a cut (bodies)
  Index body_count = 0;                // owners from here on are rigid

  bool empty() const { return triangles.empty(); }
  Index owner_count() const { return static_cast<Index>(owner_nodes.size()); }
};

}  // namespace sinew
