// The change from version n of a Model to version n + 1: the new ids of its nodes and tets, and the
// transfer of a State. A Model never changes; a cut, a tear or a refinement creates its next
// version (forces/remove_tets.h).
#pragma once

#include <vector>

#include "sinew/base/vec.h"
#include "sinew/model/model.h"
#include "sinew/model/state.h"

namespace sinew {

struct TopologyChange {
  int from = 0;             // version of the Model before; the one after is from + 1
  std::vector<Index> node;  // id in the Model after, -1: removed (nodes before)
  std::vector<Index> tet;   // id in the Model after, -1: removed (tets before)
};

// State transfer: every node of `after` that was in `before` keeps its position, its velocity and
// its contact forces from shapes of obstacles, including the ground; the other nodes start at their
// start positions. Time, steps and the energy account continue. Other contacts and the tensions of
// limits start from zero: the next step finds them again. The obstacles of both models are the
// same, in the same order. Throws Error(usage) if the versions or the sizes do not match.
State transfer_state(const TopologyChange& change, const Model& before, const Model& after,
                     const State& state);

}  // namespace sinew
