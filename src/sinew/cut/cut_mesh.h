// Cuts a mesh as planned (cut/plan_cut.h).
#pragma once

#include <vector>

#include "sinew/cut/plan_cut.h"
#include "sinew/mesh/tet_mesh.h"

namespace sinew {

struct MeshAfterCut {
  std::vector<Vec3> nodes;        // those before in their order, then the new ones
  std::vector<Tet> tets;          // those before in their order, smaller; then their other parts
  std::vector<EdgeSplit> origin;  // of each new node, from nodes with lower numbers; a copy: of one
                                  // node twice
  std::vector<Index> parent;      // tet before (tets)

  // Values at the nodes before the cut, with those of the new nodes behind them.
  template <typename T>
  void extend(std::vector<T>& values) const {
    for (const EdgeSplit& o : origin) values.push_back(o.at(values));
  }
};

// Volumes and orientations stay, to rounding. Throws Error(internal) for a cut of another mesh.
MeshAfterCut cut_mesh(const std::vector<Vec3>& nodes, const std::vector<Tet>& tets,
                      const BodyCut& cut);

}  // namespace sinew
