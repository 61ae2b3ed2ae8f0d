// The content of a SceneBuilder.
#pragma once

#include <sinew/scene_builder.h>

#include "sinew/scene/document.h"
#include "sinew/scene/scene.h"

namespace sinew {

struct SceneBuilder::Parts {
  DocValue root;
  GivenMeshes given;
};

}  // namespace sinew
