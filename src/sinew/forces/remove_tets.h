// The simplest change of topology: tets are taken out, such as those that a blade or a laser burns
// away. Masses, springs, network, volume and viscosity are those of the mesh that is left.
#pragma once

#include <span>
#include <vector>

#include "sinew/forces/assemble.h"
#include "sinew/model/topology_change.h"

namespace sinew {

struct CutModel {
  Model model;                   // version n + 1
  std::vector<BodySpec> bodies;  // what it was assembled from, for the next cut
  TopologyChange change;
};

// The Model without those tets, from the bodies that it was assembled from. Nodes that no tet is
// left at go too, and with them what holds, loads, joins or reports them; everything else keeps its
// order. Tet ids are those of `model`.
//
// The surfaces that contact knows (Model::skin, Model::surface) are those of the new mesh: they
// are left empty, for contact/touch_surface.h to build anew.
//
// Throws Error(input) where a body would have no tet left, and Error(usage) where a tet id is out
// of range or the bodies are not those of the model.
CutModel remove_tets(const Model& model, std::span<const BodySpec> bodies,
                     std::span<const Index> tets);

}  // namespace sinew
