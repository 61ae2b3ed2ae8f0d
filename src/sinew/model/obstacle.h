// Rigid things that bodies may not enter, and where they are at a time. docs/methods/obstacles.md.
#pragma once

#include <string>
#include <vector>

#include "sinew/base/vec.h"
#include "sinew/model/path.h"

namespace sinew {

enum class ObstacleShape {
  sphere,   // of `radius` about the centre
  plane,    // the half-space below the centre, its own y axis pointing out
  capsule,  // what is within `radius` of the segment of half length `half.z()` along its own z axis
  box,      // of half sides `half` along its own axes
  mesh,     // triangles between nodes of the Model that a pin moves
};

// Without a stiffness it is hard: contact with friction (contact/colliders.h, and
// contact/surfaces.h for meshes). With one it is a frictionless sphere that presses
// (forces/obstacles.h).
struct Obstacle {
  std::string name;
  Vec3 center = Vec3::Zero();  // [m], before its path moves it
  double radius = 0.0;         // [m] > 0; sphere, capsule
  double stiffness = 0.0;      // [N/m3] pressure per depth; 0: hard
  Path path = {};              // moves and turns it; never deforms it
  ObstacleShape shape = ObstacleShape::sphere;
  Mat3 rotation = Mat3::Identity();  // its own axes in the world, as columns, before the path
  Vec3 half = Vec3::Zero();          // [m] > 0; box: half sides; capsule: z, half of the segment
  double friction = 0.5;             // [-] Coulomb's mu >= 0; hard
  double restitution = 0.0;          // [-] in [0, 1], of explicit steps; hard
  Range nodes = {};                  // mesh: node ids of the Model
  std::vector<Triangle> triangles = {};  // mesh: node ids, counter-clockwise seen from outside

  bool hard() const { return stiffness == 0.0; }
};

// Where a rigid thing is: the point q of its own frame is at center + turn q.
struct Pose {
  Vec3 center = Vec3::Zero();    // [m]
  Mat3 turn = Mat3::Identity();  // its own axes in the world, as columns

  Vec3 at(const Vec3& own) const { return center + turn * own; }
  Vec3 own(const Vec3& world) const { return turn.transpose() * (world - center); }
};

// The obstacle's pose at a time [s].
Pose obstacle_pose(const Obstacle& obstacle, double time);

}  // namespace sinew
