// The simplest change of topology: tets are removed, for example by a blade or a laser. Masses,
// springs, network, volume and viscosity are those of the remaining mesh.
#pragma once

#include <span>
#include <vector>

#include "sinew/forces/assemble.h"
#include "sinew/model/topology_change.h"

namespace sinew {

struct CutModel {
  Model model;                   // version n + 1
  std::vector<BodySpec> bodies;  // the bodies that it was assembled from, for the next cut
  TopologyChange change;
};

// The Model without those tets, from the bodies that it was assembled from. Nodes without a tet are
// removed, and so are their pins, loads, ties and probes. Everything else keeps its order. Tet ids
// are those of `model`.
//
// The surfaces for contact (Model::skin, Model::surface) must be those of the new mesh: they are
// left empty and contact/contact_surface.h rebuilds them.
//
// Throws Error(input) if a body would have no tet left, and Error(usage) if a tet id is out of
// range or the bodies are not those of the model.
CutModel remove_tets(const Model& model, std::span<const BodySpec> bodies,
                     std::span<const Index> tets);

}  // namespace sinew
