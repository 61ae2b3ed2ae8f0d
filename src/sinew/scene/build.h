// Builds a Model from a scene: reads and places meshes, makes springs, selects nodes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sinew/forces/assemble.h"
#include "sinew/model/model.h"
#include "sinew/scene/scene.h"
#include "sinew/scene/short_step.h"

namespace sinew {

// Facts about the bodies for the user, before the run.
struct BuildReport {
  struct Body {
    std::string name;
    std::string mesh;  // the file, or "shape beam"
    Index nodes = 0;
    Index tets = 0;
    std::vector<std::string> warnings;  // implausible sizes, loose parts, repairs
    std::optional<ShortStep> short_step;
  };
  std::vector<Body> bodies;
  std::vector<BodySpec> specs;        // what the Model was assembled from, for cuts (bodies)
  std::vector<std::string> warnings;  // about the start (scene/start_warnings.h), distances
};

// Throws Error(input), with the place in the scene file if there is one, for a mesh that is missing
// or cannot be used, a label that the mesh does not have, a selection without nodes, a node in two
// pins. The Model's nodes are those of the mesh files in their order, without nodes that belong to
// no tet.
Model build_model(const Scene& scene, BuildReport* report = nullptr);

}  // namespace sinew
