// From version n of a Model to version n + 1: where its nodes and tets are in the new one, and how
// a State follows. A Model never changes; what cuts, tears or refines makes the next version of it
// (forces/remove_tets.h).
#pragma once

#include <vector>

#include "sinew/base/vec.h"
#include "sinew/model/model.h"
#include "sinew/model/state.h"

namespace sinew {

struct TopologyChange {
  int from = 0;             // version of the Model before; the one after is from + 1
  std::vector<Index> node;  // id in the Model after, -1: gone (nodes before)
  std::vector<Index> tet;   // id in the Model after, -1: gone (tets before)
};

// State transfer: every node of `after` that was there keeps its place, its velocity and its pushes
// from shapes of obstacles, the ground among them; the others are where they start. Time, steps and
// the energy account go on. Other contacts and the tensions of limits begin anew: the next step
// finds them again. The obstacles of both models are the same, in the same order.
// Throws Error(usage) where the versions or the sizes do not fit.
State transfer_state(const TopologyChange& change, const Model& before, const Model& after,
                     const State& state);

}  // namespace sinew
