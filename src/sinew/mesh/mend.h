// Changes of a mesh that a user has to ask for: joins double nodes, removes flat and needless tets.
// (doctor.h has the repair that changes nothing of the shape and is always made.)
#pragma once

#include <string>
#include <vector>

#include "sinew/mesh/tet_mesh.h"

namespace sinew {

struct MendReport {
  Index merged_nodes = 0;          // double nodes that now are the node they lie on
  Index needless_tets = 0;         // named a node twice, or were copies of earlier tets
  Index collapsed_edges = 0;       // short edges of flat tets
  Index collapsed_tets = 0;        // that went with those edges
  Index removed_tets = 0;          // flat tets on the surface
  Index moved_nodes = 0;           // inside, corners of flat tets
  Index flat_tets = 0;             // that remain
  std::vector<Index> merged_into;  // the node that stands for each node, often itself (nodes)
};

// Tets are flat below the radius ratio kNearFlat. Nodes keep their ids; those that no tet names any
// more remain until repair(). Edges are collapsed, and nodes moved, only where every tet around
// gets better than flat, so no other tet is inverted. A mesh with ids out of range or infinite
// coordinates is not changed.
MendReport mend(TetMesh& mesh);

// One line for each thing that was done or left; empty if there was none.
std::vector<std::string> describe(const MendReport& report);

}  // namespace sinew
