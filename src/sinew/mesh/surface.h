// The boundary of a tetrahedral mesh, and connected components.
#pragma once

#include <span>
#include <vector>

#include "sinew/base/vec.h"

namespace sinew {

// The faces that belong to exactly one tet.
struct Surface {
  std::vector<Triangle> triangles;  // node ids, counter-clockwise seen from outside, lowest node
                                    // first; sorted by their three node ids (triangles)
  std::vector<Index> tets;          // the tet behind each triangle (triangles)
};

// The outward orientation requires positive tets (see doctor.h). Node ids must be in [0,
// node_count).
Surface build_surface(std::span<const Tet> tets, Index node_count);

// Elements that share a node belong to one component. Components are numbered by their first
// element.
struct Components {
  Index count = 0;
  std::vector<Index> of;  // component (elements)
};

Components connected_components(std::span<const Tet> tets, Index node_count);
Components connected_components(std::span<const Triangle> triangles, Index node_count);

// Total area of the triangles, in the square of the nodes' unit.
double surface_area(std::span<const Vec3> nodes, std::span<const Triangle> triangles);

}  // namespace sinew
