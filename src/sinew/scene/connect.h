// Connections of bodies to points and to each other: attachments, glue, distances.
#pragma once

#include <string>
#include <vector>

#include "sinew/model/model.h"
#include "sinew/scene/place.h"
#include "sinew/scene/scene.h"

namespace sinew {

// Adds the scene's attachments and distances to the model, which must have all of its bodies.
// Throws Error(input), with the place in the scene file, for a selection without nodes, a distance
// between coincident nodes, or glue without a surface in reach. Returns warnings: distances that do
// not hold at the start.
std::vector<std::string> connect(const Scene& scene, const std::vector<PlacedBody>& bodies,
                                 Model& model);

// The body of that name.
const PlacedBody& body_named(const std::vector<PlacedBody>& bodies, const std::string& name);

// Node ids of the Model; `what` names the selection in messages.
std::vector<Index> select_in_model(const std::vector<PlacedBody>& bodies, const std::string& body,
                                   const Selection& selection, const std::string& what);

}  // namespace sinew
