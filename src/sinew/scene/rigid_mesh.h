// The triangles of a mesh obstacle or a cut, read from a surface file.
#pragma once

#include <vector>

#include "sinew/cut/cut_surface.h"
#include "sinew/scene/scene.h"

namespace sinew {

struct RigidMesh {
  std::vector<Vec3> vertices;       // in the world [m]
  std::vector<Triangle> triangles;  // indices into vertices, counter-clockwise seen from outside
};

// x = center + R(rotation) scale X. Coincident vertices become one, triangles without area are
// omitted. Error(input), at the obstacle's key `mesh`, if the file is missing or not a surface, has
// no triangle with an area, is not wound consistently, or is placed too far away.
RigidMesh read_rigid_mesh(const Scene& scene, const SceneObstacle& obstacle);

// The surface of a cut by a mesh [m]. Error(input), at the cut's key `mesh`, if the file is missing
// or not a surface.
CutTriangles read_cut_mesh(const Scene& scene, const SceneCut& cut);

}  // namespace sinew
