// From a scene to a Model: meshes read and placed, springs made, nodes selected.
#pragma once

#include <string>
#include <vector>

#include "sinew/model/model.h"
#include "sinew/scene/scene.h"

namespace sinew {

// What a user should know about the bodies before the run.
struct BuildReport {
  struct Body {
    std::string name;
    std::string mesh;  // the file, or "shape beam"
    Index nodes = 0;
    Index tets = 0;
    std::vector<std::string> warnings;  // what was repaired; sizes that look wrong
  };
  std::vector<Body> bodies;
  std::vector<std::string> warnings;  // bodies that are inside each other at the start
};

// Throws Error(input), at the place in the scene file where there is one, for a mesh that is
// missing or cannot be used, a label that the mesh does not have, a selection without nodes, a node
// held by two pins. The Model's nodes are those of the mesh files in their order, without nodes
// that no tet has.
Model build_model(const Scene& scene, BuildReport* report = nullptr);

}  // namespace sinew
