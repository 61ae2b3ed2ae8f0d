// Uniform refinement, for convergence studies.
#pragma once

#include "sinew/mesh/tet_mesh.h"

namespace sinew {

// Every tet becomes eight: four at its corners and four around the shortest diagonal of the
// octahedron between them. The old nodes keep their ids, the middle of edge e (build_edges) is node
// node_count + e. Region labels and labelled faces are kept; a middle node has the label of its two
// ends if they agree, else 0. Faces that belong to no tet are omitted. Positive tets stay
// positive. A mesh of 2^26 tets or more is an Error(input).
TetMesh subdivide(const TetMesh& mesh);

}  // namespace sinew
