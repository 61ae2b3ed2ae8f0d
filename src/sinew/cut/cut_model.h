// The next version of a Model: its bodies are cut, and everything that holds on to their nodes,
// faces and tets moves along.
#pragma once

#include <span>
#include <vector>

#include "sinew/cut/plan_cut.h"
#include "sinew/forces/assemble.h"
#include "sinew/model/topology_change.h"

namespace sinew {

// The bodies that a Model was assembled from, for its next cut.
struct CutBody {
  BodySpec spec;
  std::vector<double> node_size;  // CutMesh::size [m] (nodes)
};

// Of bodies that have not been cut.
std::vector<CutBody> whole_bodies(std::vector<BodySpec> specs);

// The same cut of every body (bodies).
using ModelCut = std::vector<BodyCut>;

struct CutModel {
  Model model;  // version n + 1
  std::vector<CutBody> bodies;
  TopologyChange change;
};

// Nodes and tets keep their order within their body; new ones come last. Materials and regions stay
// with their tets. Of a node that is doubled, the part with the larger volume keeps pins, loads,
// ties, attachments and probes:
//   pins         also hold the copies, and new nodes between two nodes of the pin
//   loads        a force stays on the nodes that had it; tractions and pressures stay on their
//                faces, which are split with the tets behind them
//   ties         of a node to a place in a tet stay at that place, now in a part of the tet
//   attachments  and distances stay with their nodes; probes too
// Contact surfaces are built again: the faces of the cut belong to them.
//
// Throws Error(usage) if the bodies are not those of the model.
CutModel cut_model(const Model& model, std::span<const CutBody> bodies, const ModelCut& cut);

}  // namespace sinew
