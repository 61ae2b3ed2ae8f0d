#include "sinew/model/obstacle.h"

#include "sinew/base/rotation.h"

namespace sinew {

Obstacle make_ground(const Vec3& point, const Vec3& normal, double restitution, double friction) {
  Obstacle o;
  o.name = "the ground";
  o.center = point;
  o.shape = shapes::Plane{};
  o.rotation = rotation_between(Vec3::UnitY(), normal).toRotationMatrix();
  o.friction = friction;
  o.restitution = restitution;
  o.listed = false;
  return o;
}

}  // namespace sinew
