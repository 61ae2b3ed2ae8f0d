// The change from version n of a Model to version n + 1: where its nodes and tets come from, and
// the transfer of a State. A Model never changes; a cut creates its next version
// (cut/cut_model.h).
#pragma once

#include <vector>

#include "sinew/base/vec.h"
#include "sinew/model/model.h"
#include "sinew/model/state.h"

namespace sinew {

// Nodes stay, get another number, and new ones come in: on an edge, or at the place of a node.
struct TopologyChange {
  struct NewNode {
    Index node = -1;       // its number in the Model after
    Index a = -1, b = -1;  // numbers there; if they are new, they stand earlier in the list
    double t = 0.0;        // [-] it lies at (1 - t) a + t b
  };
  int from = 0;             // version of the Model before; the one after is from + 1
  std::vector<Index> node;  // number in the Model after (nodes before)
  std::vector<NewNode> added;
  std::vector<Index> tet_parent;  // tet before (tets)

  // Values at the nodes of the Model after, from those before.
  template <typename T>
  std::vector<T> carried(const std::vector<T>& before) const {
    std::vector<T> after(node.size() + added.size());
    for (std::size_t i = 0; i < node.size(); ++i) after[uz(node[i])] = before[i];
    for (const NewNode& n : added)
      after[uz(n.node)] = (1.0 - n.t) * after[uz(n.a)] + n.t * after[uz(n.b)];
    return after;
  }
};

// State transfer. Positions and velocities are carried, so the deformation stays what it was in
// every part of a tet, and the momentum of lumped masses stays as well. Time, steps and the energy
// account continue. Contact forces from shapes of obstacles, including the ground, stay with their
// nodes; other contacts and the tensions of limits start from zero: the next step finds them again.
// The obstacles of both models are the same, in the same order. Throws Error(usage) if the versions
// or the sizes do not match.
State transfer_state(const TopologyChange& change, const Model& before, const Model& after,
                     const State& state);

// Gives every body the angular momentum that it had before: the free nodes whose masses changed,
// and the new ones, get velocities of a rotation about their centre of mass; all nodes do where
// those are too few. Masses at more places have another moment of inertia. `old`: the state of
// `before`.
void keep_angular_momentum(const TopologyChange& change, const Model& before, const State& old,
                           const Model& after, State& state);

}  // namespace sinew
