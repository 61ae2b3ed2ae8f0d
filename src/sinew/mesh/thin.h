// Whether a thin body has too few tets across to bend as it should.
#pragma once

#include <optional>
#include <string>

#include "sinew/mesh/tet_mesh.h"

namespace sinew {

// A warning if the mesh is a plate, a sheet or a rod whose tets are longer than it is thick, or of
// which most have all nodes on the surface. Its thickness is 2 V / A of volume and surface, that of
// a plate; a body counts as thin if it is 6 times as long. Measured on clamped strips (docs/
// methods/neo-hookean.md), the tip against plate theory: two layers, edges 1.6 times the thickness:
// -16 %, 1.05 times: +1 %; one layer: -15 to -69 %. Nodes in metres; tets positive.
std::optional<std::string> thin_warning(const TetMesh& mesh);

}  // namespace sinew
