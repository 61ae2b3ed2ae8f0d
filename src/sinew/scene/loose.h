// Parts of bodies that nothing holds, before a static solve.
#pragma once

#include "sinew/model/model.h"
#include "sinew/scene/scene.h"

namespace sinew {

// Error(input) if the stepper is `static` and a part of a body, whose tets share no node with
// others, cannot have a rest state: no pin, attachment, distance or glue holds it, nothing is there
// that it could touch, and the forces on it have a sum. Names the part, and says whether its nodes
// are doubles of another part's.
void refuse_loose_parts(const Scene& scene, const Model& model);

}  // namespace sinew
