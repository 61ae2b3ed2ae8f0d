// Rigid obstacles. model/controls.h has their poses at a time.
// docs/methods/obstacles.md.
#pragma once

#include <string>

#include "sinew/base/vec.h"
#include "sinew/model/path.h"
#include "sinew/model/shapes/shape.h"

namespace sinew {

// Without a stiffness an obstacle is hard: contact with friction (contact/colliders.h, and
// contact/surfaces.h for meshes). With a stiffness it is a frictionless sphere that presses on
// bodies (forces/obstacles.h).
struct Obstacle {
  std::string name;
  Vec3 center = Vec3::Zero();  // [m], before its path moves it
  double stiffness = 0.0;      // [N/m3] pressure per depth; 0: hard
  Path path = {};              // moves and turns it, never deforms it; the initial one of Controls
  Shape shape = shapes::Sphere{};
  Mat3 rotation = Mat3::Identity();  // its own axes in the world, as columns, before the path
  double friction = 0.5;             // [-] Coulomb's mu >= 0; hard
  double restitution = 0.0;          // [-] in [0, 1], of explicit steps; hard
  bool listed = true;  // appears in tables, readings and the host's handles; false: the ground

  bool hard() const { return stiffness == 0.0; }
  // The radius of a sphere, the only shape that can be soft [m]; 0 for other shapes.
  double soft_radius() const {
    const auto* sphere = std::get_if<shapes::Sphere>(&shape);
    return sphere != nullptr ? sphere->radius : 0.0;
  }
  // The mesh; null for other shapes.
  const shapes::Mesh* mesh() const { return std::get_if<shapes::Mesh>(&shape); }
  // The nodes of a mesh; empty for other shapes.
  Range nodes() const { return mesh() != nullptr ? mesh()->nodes : Range{0, 0}; }
};

// The pose of a rigid object: the point q of its own frame is at center + turn q.
struct Pose {
  Vec3 center = Vec3::Zero();    // [m]
  Mat3 turn = Mat3::Identity();  // its own axes in the world, as columns

  Vec3 at(const Vec3& own) const { return center + turn * own; }
  Vec3 own(const Vec3& world) const { return turn.transpose() * (world - center); }
};

// The hard half-space below `point` [m] with a unit normal that points to the free side: the
// `[ground]` of a scene. Its name contains a space, so no obstacle of a scene can have the same
// name.
Obstacle make_ground(const Vec3& point, const Vec3& normal, double restitution, double friction);

}  // namespace sinew
