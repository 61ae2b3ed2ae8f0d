#include "sinew/forces/remove_tets.h"

#include <fmt/format.h>

#include <algorithm>

#include "sinew/base/error.h"
#include "sinew/forces/obstacles.h"

namespace sinew {
namespace {

void require_bodies_of(const Model& model, std::span<const BodySpec> bodies) {
  bool same = bodies.size() == model.bodies.size();
  for (std::size_t b = 0; same && b < bodies.size(); ++b) {
    same = bodies[b].mesh.node_count() == model.bodies[b].nodes.size() &&
           bodies[b].mesh.tet_count() == model.bodies[b].tets.size();
  }
  if (!same) {
    throw Error(ErrorKind::usage, "the bodies are not those that the model was assembled from",
                "give those of the last cut, or of the build");
  }
}

// The body without the removed tets. Enters the new ids of its nodes and tets in `change`.
BodySpec cut_body(const BodySpec& spec, const Body& body, const std::vector<char>& gone,
                  Index first_node, Index first_tet, TopologyChange& change) {
  BodySpec out = spec;
  out.mesh.nodes.clear();
  out.mesh.tets.clear();
  out.tet_region.clear();
  std::vector<char> used(spec.mesh.nodes.size(), 0);
  for (Index t = 0; t < spec.mesh.tet_count(); ++t) {
    if (gone[uz(body.tets.begin + t)] != 0) continue;
    for (const Index corner : spec.mesh.tets[uz(t)]) used[uz(corner)] = 1;
  }
  std::vector<Index> at(used.size(), -1);  // ids in the new mesh
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i] == 0) continue;
    at[i] = out.mesh.node_count();
    change.node[uz(body.nodes.begin) + i] = first_node + at[i];
    out.mesh.nodes.push_back(spec.mesh.nodes[i]);
  }
  for (Index t = 0; t < spec.mesh.tet_count(); ++t) {
    if (gone[uz(body.tets.begin + t)] != 0) continue;
    change.tet[uz(body.tets.begin + t)] = first_tet + out.mesh.tet_count();
    Tet tet = spec.mesh.tets[uz(t)];
    for (Index& corner : tet) corner = at[uz(corner)];
    out.mesh.tets.push_back(tet);
    if (!spec.tet_region.empty()) out.tet_region.push_back(spec.tet_region[uz(t)]);
  }
  if (out.mesh.tets.empty()) {
    throw Error(ErrorKind::input, fmt::format("no tet of body '{}' would be left", spec.name),
                "leave one, or take the body out of the scene");
  }
  return out;
}

std::vector<Index> still_there(const std::vector<Index>& nodes, const TopologyChange& change) {
  std::vector<Index> out;
  for (const Index node : nodes) {
    if (change.node[uz(node)] >= 0) out.push_back(change.node[uz(node)]);
  }
  return out;
}

template <std::size_t N>
bool move(std::array<Index, N>& nodes, const TopologyChange& change) {
  for (Index& node : nodes) node = change.node[uz(node)];
  return std::all_of(nodes.begin(), nodes.end(), [](Index node) { return node >= 0; });
}

Load moved(const Load& load, const TopologyChange& change) {
  Load out = load;
  out.nodes = still_there(load.nodes, change);
  // The remaining nodes of a force carry the same force per node as before.
  if (!load.nodes.empty())
    out.force *= static_cast<double>(out.nodes.size()) / static_cast<double>(load.nodes.size());
  out.faces.clear();
  out.rest_area.clear();
  for (std::size_t f = 0; f < load.faces.size(); ++f) {
    Triangle face = load.faces[f];
    if (!move(face, change)) continue;
    out.faces.push_back(face);
    out.rest_area.push_back(load.rest_area[f]);
  }
  return out;
}

// Copies the nodes that belong to no body: anchors and the nodes of rigid meshes.
void copy_outer_nodes(const Model& from, Model& to, TopologyChange& change) {
  for (auto i = uz(from.body_node_count()); i < from.rest_position.size(); ++i) {
    change.node[i] = to.node_count();
    to.rest_position.push_back(from.rest_position[i]);
    to.mass.push_back(from.mass[i]);
    to.drag.push_back(from.drag[i]);
    to.start_velocity.push_back(from.start_velocity[i]);
  }
}

void copy_attachments(const Model& from, Model& to, const TopologyChange& change) {
  for (auto s = uz(from.first_attachment); s < from.springs.size(); ++s) {
    Edge ends = from.springs[s];
    if (!move(ends, change)) continue;
    add_attachment(to, ends[0], ends[1], from.stiffness[s], from.damping[s], from.rest_length[s]);
    to.stretch_limit.back() = from.stretch_limit[s];
    to.compress_limit.back() = from.compress_limit[s];
  }
}

void copy_surroundings(const Model& from, Model& to, const TopologyChange& change) {
  to.start_gravity = from.start_gravity;
  to.body_contact = from.body_contact;
  to.limit_sweeps = from.limit_sweeps;
  to.limit_tolerance = from.limit_tolerance;
  for (const Pin& pin : from.pins)
    to.pins.push_back({pin.name, still_there(pin.nodes, change), pin.path});
  for (const Load& load : from.loads) {
    Load left = moved(load, change);
    if (!left.nodes.empty() || !left.faces.empty()) to.loads.push_back(std::move(left));
  }
  for (Tie tie : from.ties) {
    if (move(tie.node, change)) to.ties.push_back(tie);
  }
  for (const Probe& probe : from.probes)
    to.probes.push_back({probe.name, still_there(probe.nodes, change)});
  for (Obstacle obstacle : from.obstacles) {
    if (auto* mesh = std::get_if<shapes::Mesh>(&obstacle.shape)) {
      const Index first = change.node[uz(mesh->nodes.begin)];
      mesh->nodes = {first, first + mesh->nodes.size()};
      for (Triangle& t : mesh->triangles) move(t, change);
    }
    add_obstacle(to, std::move(obstacle));
  }
}

}  // namespace

CutModel remove_tets(const Model& model, std::span<const BodySpec> bodies,
                     std::span<const Index> tets) {
  require_bodies_of(model, bodies);
  std::vector<char> gone(model.tets.size(), 0);
  for (const Index t : tets) {
    if (t < 0 || t >= model.tet_count()) {
      throw Error(ErrorKind::usage, fmt::format("no tet {}", t),
                  fmt::format("from 0 to {}", model.tet_count() - 1));
    }
    gone[uz(t)] = 1;
  }
  CutModel cut;
  Model& to = cut.model;
  TopologyChange& change = cut.change;
  change.from = model.version;
  change.node.assign(model.rest_position.size(), -1);
  change.tet.assign(model.tets.size(), -1);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    cut.bodies.push_back(
        cut_body(bodies[b], model.bodies[b], gone, to.node_count(), to.tet_count(), change));
    add_body(to, cut.bodies.back());
  }
  to.version = model.version + 1;
  if (!model.start_position.empty()) to.start_position.resize(uz(to.body_node_count()));
  for (Index i = 0; i < model.body_node_count(); ++i) {
    if (change.node[uz(i)] < 0) continue;
    const auto n = uz(change.node[uz(i)]);
    to.start_velocity[n] = model.start_velocity[uz(i)];
    if (!model.start_position.empty()) to.start_position[n] = model.start_position[uz(i)];
  }
  copy_outer_nodes(model, to, change);
  copy_attachments(model, to, change);
  copy_surroundings(model, to, change);
  finish(to);
  return cut;
}

}  // namespace sinew
