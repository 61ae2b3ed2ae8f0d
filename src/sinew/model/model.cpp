#include "sinew/model/model.h"

#include <algorithm>

#include <fmt/format.h>

#include "sinew/base/hash.h"

namespace sinew {
namespace {

void hash_vec(Hash& h, const Vec3& v) {
  h.value(v.x());
  h.value(v.y());
  h.value(v.z());
}

void hash_path(Hash& h, const Path& path) {
  hash_vec(h, path.pivot);
  h.value(path.smooth);
  for (const KeyFrame& k : path.keys) {
    h.value(k.time);
    hash_vec(h, k.move);
    hash_vec(h, k.turn);
    for (const double f : k.deform.reshaped()) h.value(f);
  }
}

void hash_cells(Hash& h, const GradientCells& cells) {
  h.array(cells.start);
  h.array(cells.node);
  h.array(cells.gradient);
  h.array(cells.volume);
}

}  // namespace

bool Model::bounces() const {
  return (body_contact && body_contact->restitution > 0.0) ||
         std::any_of(obstacles.begin(), obstacles.end(),
                     [](const Obstacle& o) { return o.hard() && o.restitution > 0.0; });
}

std::uint64_t Model::hash() const {
  Hash h;
  h.array(rest_position);
  h.array(mass);
  h.array(inverse_mass);
  h.array(drag);
  h.array(start_velocity);
  h.array(start_position);
  h.array(tets);
  h.array(tet_region);
  h.array(tet_viscosity);
  h.array(springs);
  h.array(stiffness);
  h.array(rest_length);
  h.array(damping);
  h.array(stretch_limit);
  h.array(compress_limit);
  h.array(network_node);
  h.array(network_stiffness);
  hash_cells(h, edge_cells);
  h.array(edge_shear);
  h.array(edge_bulk);
  h.array(tet_shear);
  h.array(tet_bulk);
  h.array(tet_guard);
  h.array(cells);
  h.array(cell_share);
  h.array(cell_bulk);
  h.array(volume_limit);
  hash_cells(h, viscous_cells);
  h.array(viscous_weight);
  h.array(limited);
  h.array(colour_start);
  h.value(limit_sweeps);
  h.value(limit_tolerance);
  hash_vec(h, start_gravity);
  h.value(body_contact.has_value());
  if (body_contact) {
    h.value(body_contact->bodies);
    h.value(body_contact->self);
    h.value(body_contact->friction);
    h.value(body_contact->restitution);
  }
  for (const Body& b : bodies) {
    h.text(b.name);
    h.value(b.nodes.end);
  }
  for (const Pin& pin : pins) {
    h.text(pin.name);
    h.array(pin.nodes);
    hash_path(h, pin.path);
  }
  for (const Load& load : loads) {
    h.array(load.nodes);
    hash_vec(h, load.force);
    h.value(load.start);
    h.value(load.end);
    h.value(load.ramp);
    h.array(load.faces);
    h.array(load.rest_area);
    hash_vec(h, load.traction);
    h.value(load.pressure);
  }
  for (const Probe& probe : probes) {
    h.text(probe.name);
    h.array(probe.nodes);
  }
  for (const Obstacle& o : obstacles) {
    h.text(o.name);
    hash_vec(h, o.center);
    h.value(o.stiffness);
    hash_path(h, o.path);
    h.text(std::string(word_of(o.shape)));
    std::visit(Overloaded{[&](const shapes::Mesh& mesh) {
                            h.value(mesh.nodes.begin);
                            h.array(mesh.triangles);
                          },
                          [&](const SolidShape auto& solid) { hash_vec(h, solid.sizes()); }},
               o.shape);
    for (const double r : o.rotation.reshaped()) h.value(r);
    h.value(o.friction);
    h.value(o.restitution);
  }
  for (const Tie& tie : ties) {
    for (const Index node : tie.node) h.value(node);
    for (const double weight : tie.weight) h.value(weight);
    h.value(tie.stiffness);
  }
  return h.digest();
}

std::string Model::node_name(Index node) const {
  for (const Body& b : bodies) {
    if (b.nodes.contains(node)) {
      return fmt::format("body {}, node {}", b.name, node - b.nodes.begin);
    }
  }
  for (const Obstacle& o : obstacles) {
    if (o.mesh() != nullptr && o.mesh()->nodes.contains(node))
      return fmt::format("obstacle {}, vertex {}", o.name, node - o.mesh()->nodes.begin);
  }
  return fmt::format("anchor {}", node - body_node_count());
}

}  // namespace sinew
