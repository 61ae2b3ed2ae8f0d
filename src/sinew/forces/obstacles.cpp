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

void add_obstacle(Model& model, Obstacle obstacle) {
  const bool hard = obstacle.hard();
  model.obstacles.push_back(std::move(obstacle));
  if (hard || !model.surface_share.empty()) return;
  model.surface_share.assign(uz(model.body_node_count()), 0.0);
  for (const Triangle& t : build_surface(model.tets, model.body_node_count()).triangles) {
    const double third = area_vector(model.rest_position, t).norm() / 3.0;
    for (const Index corner : t) model.surface_share[uz(corner)] += third;
  }
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

std::vector<Vec3> obstacle_centers(const Model& model, double time) {
  std::vector<Vec3> centers;
  for (const Obstacle& o : model.obstacles) centers.push_back(o.path.at(time, o.center));
  return centers;
}

double ObstacleTerm::energy(const Configuration& at) {
  const Model& model = at.model;
  const std::vector<Vec3> centers = obstacle_centers(model, at.time);
  return parallel_sum(static_cast<Index>(model.surface_share.size()), [&](Index i) {
    const auto n = uz(i);
    double energy = 0.0;
    for (std::size_t c = 0; c < centers.size() && model.inverse_mass[n] > 0.0; ++c) {
      const Obstacle& o = model.obstacles[c];
      energy += obstacle_energy(at.x[n] - centers[c], o.soft_radius(),
                                o.stiffness * model.surface_share[n]);
    }
    return energy;
  });
}

void ObstacleTerm::add_forces(const Configuration& at, std::span<Vec3> forces) {
  const Model& model = at.model;
  const std::vector<Vec3> centers = obstacle_centers(model, at.time);
  for_each_surface_node(model, [&](std::size_t n) {
    for (std::size_t c = 0; c < centers.size(); ++c) {
      const Obstacle& o = model.obstacles[c];
      forces[n] += obstacle_push(at.x[n] - centers[c], o.soft_radius(),
                                 o.stiffness * model.surface_share[n]);
    }
  });
}

std::vector<ObstacleReading> read_obstacles(const Model& model, std::span<const Vec3> x,
                                            double time) {
  std::vector<ObstacleReading> readings;
  for (const Obstacle& o : model.obstacles) {
    ObstacleReading reading;
    reading.name = o.name;
    reading.center = o.path.at(time, o.center);
    reading.travel = reading.center - o.path.at(0.0, o.center);
    for (std::size_t n = 0; n < model.surface_share.size(); ++n) {
      if (o.hard() || model.surface_share[n] == 0.0 || model.inverse_mass[n] == 0.0) continue;
      const Vec3 r = x[n] - reading.center;
      const double depth = o.soft_radius() - r.norm();
      if (depth <= 0.0) continue;
      reading.force -= obstacle_push(r, o.soft_radius(), o.stiffness * model.surface_share[n]);
      reading.depth = std::max(reading.depth, depth);
      ++reading.contacts;
    }
    readings.push_back(std::move(reading));
  }
  return readings;
}

}  // namespace sinew
