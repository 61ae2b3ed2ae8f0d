// The triangles of an obstacle that is a mesh, read from a file of a surface and placed.
#pragma once

#include <vector>

#include "sinew/scene/scene.h"

namespace sinew {

struct RigidMesh {
  std::vector<Vec3> vertices;       // in the world [m]
  std::vector<Triangle> triangles;  // indices into vertices, counter-clockwise seen from outside
};

// x = center + R(rotation) scale X. Vertices in one place become one, triangles without area are
// left out. Error(input), at the obstacle's key `mesh`, where the file is missing or no surface,
// has no triangle with an area, is not wound the same way all over, or is placed too far out.
RigidMesh read_rigid_mesh(const Scene& scene, const SceneObstacle& obstacle);

}  // namespace sinew
