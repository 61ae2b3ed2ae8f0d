#include "sinew/forces/obstacles.h"

#include "sinew/base/parallel.h"
#include "sinew/forces/loads.h"
#include "sinew/mesh/surface.h"

namespace sinew {
namespace {

// Calls f(node) for every free node of the surface, in parallel.
template <typename F>
void for_each_surface_node(const Model& model, const F& f) {
  parallel_for(static_cast<Index>(model.surface_share.size()), [&](Index i) {
    if (model.surface_share[uz(i)] > 0.0 && model.inverse_mass[uz(i)] > 0.0) f(uz(i));
  });
}

}  // namespace

void build_surface_share(Model& model) {
  if (!model.surface_share.empty()) return;
  model.surface_share.assign(uz(model.body_node_count()), 0.0);
  for (const Triangle& t : build_surface(model.tets, model.body_node_count()).triangles) {
    const double third = area_vector(model.rest_position, t).norm() / 3.0;
    for (const Index corner : t) model.surface_share[uz(corner)] += third;
  }
}

void add_obstacle(Model& model, Obstacle obstacle) {
  if (!obstacle.hard()) build_surface_share(model);
  model.obstacles.push_back(std::move(obstacle));
}

void add_mesh_obstacle(Model& model, Obstacle obstacle, std::span<const Vec3> vertices,
                       std::span<const Triangle> triangles) {
  const Index first = model.node_count();
  shapes::Mesh mesh;
  mesh.nodes = {first, first + static_cast<Index>(vertices.size())};
  Pin pin{obstacle.name, {}, obstacle.path};
  for (const Vec3& x : vertices) {
    pin.nodes.push_back(model.node_count());
    model.rest_position.push_back(x);
    model.mass.push_back(0.0);
    model.drag.push_back(0.0);
    model.start_velocity.push_back(Vec3::Zero());
  }
  for (const Triangle& t : triangles)
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  obstacle.shape = std::move(mesh);
  model.pins.push_back(std::move(pin));
  add_obstacle(model, std::move(obstacle));
}

SoftSphere soft_sphere(const Model& model, const Controls& controls, std::size_t obstacle,
                       double time) {
  const Obstacle& o = model.obstacles[obstacle];
  return {controls.obstacle_paths[obstacle].at(time, o.center), o.soft_radius(), o.stiffness};
}

SoftSphere soft_sphere(const Tool& tool, double time) {
  return {tool.path.at(time, tool.center), tool.radius, tool.stiffness};
}

std::vector<SoftSphere> soft_spheres(const Model& model, const Controls& controls, double time) {
  std::vector<SoftSphere> spheres;
  for (std::size_t o = 0; o < model.obstacles.size(); ++o)
    if (!model.obstacles[o].hard()) spheres.push_back(soft_sphere(model, controls, o, time));
  for (const Tool& tool : controls.tools) spheres.push_back(soft_sphere(tool, time));
  return spheres;
}

double ObstacleTerm::energy(const Configuration& at) {
  const Model& model = at.model;
  const std::vector<SoftSphere> spheres = soft_spheres(model, at.controls, at.time);
  if (spheres.empty()) return 0.0;
  return parallel_sum(static_cast<Index>(model.surface_share.size()), [&](Index i) {
    const auto n = uz(i);
    if (model.inverse_mass[n] == 0.0) return 0.0;
    double energy = 0.0;
    for (const SoftSphere& s : spheres)
      energy += obstacle_energy(at.x[n] - s.center, s.radius, s.stiffness * model.surface_share[n]);
    return energy;
  });
}

void ObstacleTerm::add_forces(const Configuration& at, std::span<Vec3> forces) {
  const Model& model = at.model;
  const std::vector<SoftSphere> spheres = soft_spheres(model, at.controls, at.time);
  if (spheres.empty()) return;
  for_each_surface_node(model, [&](std::size_t n) {
    for (const SoftSphere& s : spheres)
      forces[n] +=
          obstacle_force(at.x[n] - s.center, s.radius, s.stiffness * model.surface_share[n]);
  });
}

SoftReading read_soft_sphere(const Model& model, const SoftSphere& sphere,
                             std::span<const Vec3> x) {
  SoftReading reading;
  for_each_pressed(model, sphere, x, [&](std::size_t, const Vec3& r, const Vec3& force) {
    reading.force -= force;
    reading.depth = std::max(reading.depth, sphere.radius - r.norm());
    ++reading.contacts;
  });
  return reading;
}

std::vector<ObstacleReading> read_obstacles(const Configuration& at) {
  std::vector<ObstacleReading> readings;
  for (std::size_t o = 0; o < at.model.obstacles.size(); ++o) {
    const Obstacle& obstacle = at.model.obstacles[o];
    const Path& path = at.controls.obstacle_paths[o];
    ObstacleReading reading;
    reading.name = obstacle.name;
    reading.center = path.at(at.time, obstacle.center);
    reading.travel = reading.center - path.at(0.0, obstacle.center);
    if (!obstacle.hard()) {
      const SoftReading soft =
          read_soft_sphere(at.model, soft_sphere(at.model, at.controls, o, at.time), at.x);
      reading.force = soft.force;
      reading.depth = soft.depth;
      reading.contacts = soft.contacts;
    }
    readings.push_back(std::move(reading));
  }
  return readings;
}

}  // namespace sinew
