// One body of a scene: its mesh is read or made, repaired, scaled and placed in the world.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sinew/mesh/tet_mesh.h"
#include "sinew/scene/scene.h"
#include "sinew/scene/short_step.h"

namespace sinew {

inline constexpr double largest_place = 1e9;  // largest coordinate [m]

struct PlacedBody {
  const SceneBody* body = nullptr;
  std::string source;               // the mesh file, or "shape beam"
  TetMesh mesh;                     // sound, in the world [m]
  std::vector<Index> node_of_file;  // mesh node (nodes of the file, or the vertices of a surface);
                                    // -1: in no tet, left out
  Vec3 low = Vec3::Zero();          // bounding box [m]
  Vec3 high = Vec3::Zero();
  Index first_node = 0;               // of the body in the Model
  io::ReadNotes notes;                // of the file: where its labels come from
  std::vector<std::string> warnings;  // unit and weight, then loose parts, then the rest
  std::optional<ShortStep> short_step;

  double diagonal() const { return (high - low).norm(); }
};

// x = position + R (scale X - origin). Error(input) if the mesh is missing, cannot be used
// (mesh/doctor.h), or is so large, so small or so far from the origin that its tets lose their
// volume.
PlacedBody place(const Scene& scene, const SceneBody& body);

}  // namespace sinew
