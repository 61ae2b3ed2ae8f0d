// Soft spheres: soft obstacles and tools (model/controls.h), rigid and frictionless, that press on
// the surface of bodies. Hard obstacles are contacts (contact/colliders.h) and have no forces here.
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
inline Vec3 obstacle_force(const Vec3& r, double radius, double stiffness) {
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

// Fills Model::surface_share, the area on which soft spheres press. Call after the last add_body;
// does nothing if it is filled already.
void build_surface_share(Model& model);

// Adds the obstacle to the model. Call after the last add_body.
void add_obstacle(Model& model, Obstacle obstacle);

// Adds a rigid triangle mesh. Its vertices in the world [m] become nodes of the Model that a pin
// moves along the obstacle's path, like anchors; triangles are indices into `vertices`. Call after
// the last add_body.
void add_mesh_obstacle(Model& model, Obstacle obstacle, std::span<const Vec3> vertices,
                       std::span<const Triangle> triangles);

// A soft obstacle or a tool at a time.
struct SoftSphere {
  Vec3 center = Vec3::Zero();  // [m]
  double radius = 0.0;         // [m]
  double stiffness = 0.0;      // [N/m3] pressure per depth
};
SoftSphere soft_sphere(const Model& model, const Controls& controls, std::size_t obstacle,
                       double time);
SoftSphere soft_sphere(const Tool& tool, double time);

// All of them at a time [s]: the soft obstacles in the Model's order, then the tools.
std::vector<SoftSphere> soft_spheres(const Model& model, const Controls& controls, double time);

struct ObstacleTerm {
  static constexpr Account account = Account::contact;

  static double energy(const Configuration& at);
  static void add_forces(const Configuration& at, std::span<Vec3> forces);
  // Visits one element for every node that a sphere presses.
  template <class F>
  static void for_each_element(const Configuration& at, Tangent tangent, const F& visit);
  // Sum of k A of the spheres; 0 off the surface. A step that is stable with it is stable for any
  // nodes that the spheres come to touch.
  static double most_stiffness(const Model& model, const Controls& controls, Index node) {
    if (uz(node) >= model.surface_share.size()) return 0.0;
    const double share = model.surface_share[uz(node)];
    double sum = 0.0;
    for (const Obstacle& o : model.obstacles) sum += o.stiffness * share;
    for (const Tool& tool : controls.tools) sum += tool.stiffness * share;
    return sum;
  }
};

template <class F>
void ObstacleTerm::for_each_element(const Configuration& at, Tangent tangent, const F& visit) {
  for (const SoftSphere& s : soft_spheres(at.model, at.controls, at.time)) {
    for (Index node = 0; node < static_cast<Index>(at.model.surface_share.size()); ++node) {
      const double k = s.stiffness * at.model.surface_share[uz(node)];
      const Vec3 r = at.x[uz(node)] - s.center;
      if (k == 0.0 || at.model.inverse_mass[uz(node)] == 0.0 || r.norm() >= s.radius) continue;
      Mat3 block;
      for (int axis = 0; axis < 3; ++axis) {
        block.col(axis) = obstacle_stiffness_times(r, s.radius, k, Vec3::Unit(axis),
                                                   tangent == Tangent::only_stiffening);
      }
      // Along r the stiffness is k, across it -k (R / |r| - 1).
      const double norm = k * std::max(1.0, s.radius / r.norm() - 1.0);
      constexpr double one = 1.0;
      visit(Element{{&node, 1}, {&one, 1}, block, norm});
    }
  }
}

// Calls f(node, r, force) for every node that the sphere presses at x [m] (nodes), in ascending
// order: r from its centre to the node [m], force on the node [N].
template <class F>
void for_each_pressed(const Model& model, const SoftSphere& sphere, std::span<const Vec3> x,
                      const F& f) {
  for (std::size_t n = 0; n < model.surface_share.size(); ++n) {
    if (model.surface_share[n] == 0.0 || model.inverse_mass[n] == 0.0) continue;
    const Vec3 r = x[n] - sphere.center;
    if (sphere.radius - r.norm() <= 0.0) continue;
    f(n, r, obstacle_force(r, sphere.radius, sphere.stiffness * model.surface_share[n]));
  }
}

// The interaction of a sphere and the bodies.
struct SoftReading {
  Vec3 force = Vec3::Zero();  // of the bodies on the sphere [N]
  double depth = 0.0;         // of the deepest node [m]
  Index contacts = 0;         // nodes that it presses
};
SoftReading read_soft_sphere(const Model& model, const SoftSphere& sphere, std::span<const Vec3> x);

// Calls f(work) for every sphere that moves from the time `from` to `to` [s]: the force of the
// bodies on it in the configuration `now`, times its displacement [J].
template <class F>
void for_each_work_on_spheres(const Configuration& now, double from, double to, const F& f) {
  const auto at = [&](double time) { return soft_spheres(now.model, now.controls, time); };
  const std::vector<SoftSphere> spheres = at(now.time);
  const std::vector<SoftSphere> before = at(from);
  const std::vector<SoftSphere> after = at(to);
  for (std::size_t s = 0; s < spheres.size(); ++s) {
    const Vec3 displacement = after[s].center - before[s].center;
    if (displacement.isZero(0.0)) continue;
    f(read_soft_sphere(now.model, spheres[s], now.x).force.dot(displacement));
  }
}

// The interaction of an obstacle and the bodies.
struct ObstacleReading {
  std::string name;
  Vec3 center = Vec3::Zero();  // [m]
  Vec3 travel = Vec3::Zero();  // of the centre since time 0 [m]
  Vec3 force = Vec3::Zero();   // of the bodies on the obstacle [N]
  Vec3 torque = Vec3::Zero();  // about the center [N m]; 0 on a soft sphere
  double depth = 0.0;          // of the deepest node [m]
  Index contacts = 0;          // nodes that it presses
};
// The force on the obstacle against its travel [N]: that on an indenter, > 0 if it is pushed back.
// 0 before it has moved.
inline double against_travel(const ObstacleReading& reading) {
  const double travel = reading.travel.norm();
  return travel > 0.0 ? -reading.force.dot(reading.travel) / travel : 0.0;
}

// Name, centre and travel of all obstacles; force, depth and contacts of the soft ones.
std::vector<ObstacleReading> read_obstacles(const Configuration& at);

}  // namespace sinew
