// Bodies for the tests of the room.
#pragma once

#include "sinew/forces/assemble.h"

namespace sinew::test {

// A body of one material.
inline BodySpec body_of(const TetMesh& mesh, const Material& material) {
  BodySpec body;
  body.name = "body";
  body.mesh = mesh;
  body.materials = {material};
  body.regions = {"all"};
  return body;
}

}  // namespace sinew::test
