// Soft obstacles: rigid, frictionless spheres that press on the surface of bodies. Hard obstacles
// are contacts (contact/colliders.h) and have no forces here.
// docs/methods/obstacles.md.
//
// A surface node at x whose share of the surface area at rest is A is pushed out of the sphere of
// centre c and radius R by a pressure proportional to its depth:
//
//   W = k A/2 max(0, R - |x - c|)^2
//
// Only free nodes are pushed; edges and triangles are not tested.
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "sinew/forces/term.h"

namespace sinew {

// The formula on plain values: r = x - c [m], radius [m], stiffness k A [N/m].
// A node exactly at the centre has no direction: no force.
inline double obstacle_energy(const Vec3& r, double radius, double stiffness) {
  const double depth = std::max(0.0, radius - r.norm());
  return 0.5 * stiffness * depth * depth;
}

// The force on the node, k A (R - |r|) r / |r| [N].
inline Vec3 obstacle_push(const Vec3& r, double radius, double stiffness) {
  const double distance = r.norm();
  if (distance >= radius || distance == 0.0) return Vec3::Zero();
  return (stiffness * (radius / distance - 1.0)) * r;
}

// The second derivative of the energy times u: k A [n (n . u) - (R/|r| - 1) (u - n (n . u))]. With
// `only_stiffening` the negative part, across n, is left out: positive semidefinite.
inline Vec3 obstacle_stiffness_times(const Vec3& r, double radius, double stiffness, const Vec3& u,
                                     bool only_stiffening = false) {
  const double distance = r.norm();
  if (distance >= radius || distance == 0.0) return Vec3::Zero();
  const Vec3 along = (r.dot(u) / (distance * distance)) * r;
  if (only_stiffening) return stiffness * along;
  return stiffness * (along - (radius / distance - 1.0) * (u - along));
}

// Adds the obstacle to the model. Call after the last add_body.
void add_obstacle(Model& model, Obstacle obstacle);

// Adds a rigid triangle mesh. Its vertices in the world [m] become nodes of the Model that a pin
// moves along the obstacle's path, like anchors; triangles are indices into `vertices`. Call after
// the last add_body.
void add_mesh_obstacle(Model& model, Obstacle obstacle, std::span<const Vec3> vertices,
                       std::span<const Triangle> triangles);

// The centres of the obstacles at a time [m] (obstacles).
std::vector<Vec3> obstacle_centers(const Model& model, double time);

struct ObstacleTerm {
  static constexpr Account account = Account::contact;
  static constexpr bool isotropic = false;

  static double energy(const Configuration& at);
  static void add_forces(const Configuration& at, std::span<Vec3> forces);
  // Visits one element for every node that an obstacle pushes.
  template <class F>
  static void for_each_element(const Configuration& at, Tangent tangent, const F& visit);
  // Sum of k A of the obstacles; 0 off the surface. A step that is stable with it is stable for any
  // nodes that the obstacles come to touch.
  static double most_stiffness(const Model& model, Index node) {
    if (uz(node) >= model.surface_share.size()) return 0.0;
    double sum = 0.0;
    for (const Obstacle& o : model.obstacles) sum += o.stiffness * model.surface_share[uz(node)];
    return sum;
  }
};

template <class F>
void ObstacleTerm::for_each_element(const Configuration& at, Tangent tangent, const F& visit) {
  const std::vector<Vec3> centers = obstacle_centers(at.model, at.time);
  for (std::size_t c = 0; c < centers.size(); ++c) {
    const Obstacle& o = at.model.obstacles[c];
    if (o.hard()) continue;
    for (Index node = 0; node < static_cast<Index>(at.model.surface_share.size()); ++node) {
      const double k = o.stiffness * at.model.surface_share[uz(node)];
      const Vec3 r = at.x[uz(node)] - centers[c];
      if (k == 0.0 || at.model.inverse_mass[uz(node)] == 0.0 || r.norm() >= o.soft_radius())
        continue;
      Mat3 block;
      for (int axis = 0; axis < 3; ++axis) {
        block.col(axis) = obstacle_stiffness_times(r, o.soft_radius(), k, Vec3::Unit(axis),
                                                   tangent == Tangent::only_stiffening);
      }
      // Along r the stiffness is k, across it -k (R / |r| - 1).
      const double norm = k * std::max(1.0, o.soft_radius() / r.norm() - 1.0);
      constexpr double one = 1.0;
      visit(Element{{&node, 1}, {&one, 1}, block, norm});
    }
  }
}

// The interaction of an obstacle and the bodies.
struct ObstacleReading {
  std::string name;
  Vec3 center = Vec3::Zero();  // [m]
  Vec3 travel = Vec3::Zero();  // of the centre since time 0 [m]
  Vec3 force = Vec3::Zero();   // of the bodies on the obstacle [N]
  double depth = 0.0;          // of the deepest node [m]
  Index contacts = 0;          // nodes that it pushes
};
// The force on the obstacle against its travel [N]: that on an indenter, > 0 if it is pushed back.
// 0 before it has moved.
inline double against_travel(const ObstacleReading& reading) {
  const double travel = reading.travel.norm();
  return travel > 0.0 ? -reading.force.dot(reading.travel) / travel : 0.0;
}

// Name, centre and travel of all obstacles; force, depth and contacts of the soft ones.
std::vector<ObstacleReading> read_obstacles(const Model& model, std::span<const Vec3> x,
                                            double time);

}  // namespace sinew
