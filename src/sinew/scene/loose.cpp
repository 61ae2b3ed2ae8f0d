#include "sinew/scene/loose.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "sinew/base/error.h"
#include "sinew/forces/loads.h"
#include "sinew/mesh/doubles.h"
#include "sinew/mesh/node_sets.h"

namespace sinew {
namespace {

constexpr double balanced = 1e-6;  // sum of the forces over the sum of their sizes

bool may_touch(const Scene& scene, const Model& model) {
  return scene.contact.has_value() || !model.obstacles.empty();
}

// The sum of all forces on each set (its root), and the sum of their sizes.
struct Resultant {
  Vec3 force = Vec3::Zero();
  double size = 0.0;
  void add(const Vec3& f) {
    force += f;
    size += f.norm();
  }
};

std::vector<Resultant> resultants(const Model& model, NodeSets& sets) {
  std::vector<Resultant> out(model.rest_position.size());
  const auto at = [&](Index node) -> Resultant& { return out[uz(sets.root(node))]; };
  for (Index i = 0; i < model.body_node_count(); ++i)
    at(i).add(model.mass[uz(i)] * model.start_gravity);
  for (const Load& load : model.loads) {
    for (const Index node : load.nodes)
      at(node).add(load.force / static_cast<double>(load.nodes.size()));
    for (std::size_t f = 0; f < load.faces.size(); ++f) {
      const Triangle& t = load.faces[f];
      at(t[0]).add(load.rest_area[f] * load.traction -
                   load.pressure * area_vector(model.rest_position, t));
    }
  }
  return out;
}

[[noreturn]] void refuse(const Scene& scene, const Model& model, NodeSets& sets, Index root) {
  const auto body = std::find_if(model.bodies.begin(), model.bodies.end(), [&](const Body& b) {
    return root >= b.nodes.begin && root < b.nodes.end;
  });
  Index tets = 0, nodes = 0, all = 0;
  for (Index t = body->tets.begin; t < body->tets.end; ++t)
    if (sets.root(model.tets[uz(t)][0]) == root) ++tets;
  Vec3 low = model.rest_position[uz(root)], high = low;
  for (Index i = body->nodes.begin; i < body->nodes.end; ++i) {
    ++all;
    if (sets.root(i) != root) continue;
    ++nodes;
    low = low.cwiseMin(model.rest_position[uz(i)]);
    high = high.cwiseMax(model.rest_position[uz(i)]);
  }
  Index doubles = 0;
  for (const auto& [i, j] : find_doubles(model.rest_position, model.tets)) {
    const bool one = sets.root(i) == root, other = sets.root(j) == root;
    if (one != other) ++doubles;
  }
  const std::string part =
      nodes == all ? fmt::format("[body.{}]", body->name)
                   : fmt::format(
                         "a part of [body.{}] ({} of its tets, from ({:.4g}, {:.4g}, "
                         "{:.4g}) to ({:.4g}, {:.4g}, {:.4g}) m)",
                         body->name, tets, low.x(), low.y(), low.z(), high.x(), high.y(), high.z());
  const auto said = std::find_if(scene.bodies.begin(), scene.bodies.end(),
                                 [&](const SceneBody& b) { return b.name == body->name; });
  throw Error(
      ErrorKind::input,
      fmt::format("nothing holds {}, so it falls and has no rest state{}", part,
                  doubles > 0 ? fmt::format("; {} of its nodes lie on nodes of another part and "
                                            "are not joined to them",
                                            doubles)
                              : ""),
      doubles > 0 ? "repair = true of the body (or sinew repair) joins double nodes; otherwise pin "
                    "or attach the part"
                  : "pin it, attach it, or give it a ground or [contact] to lie on; stepper = "
                    "\"implicit\" lets it fall",
      said == scene.bodies.end() ? Location{} : said->where);
}

}  // namespace

void refuse_loose_parts(const Scene& scene, const Model& model) {
  if (scene.stepper != StepperKind::rest || may_touch(scene, model)) return;
  NodeSets sets(model.node_count());
  for (const Tet& t : model.tets)
    for (std::size_t c = 1; c < 4; ++c) sets.join(t[0], t[c]);
  std::vector<char> held(model.rest_position.size(), 0);
  for (Index s = model.first_attachment; s < model.spring_count(); ++s)
    sets.join(model.springs[uz(s)][0], model.springs[uz(s)][1]);
  for (const Tie& tie : model.ties)
    for (const Index node : tie.node) sets.join(tie.node[0], node);
  for (Index i = 0; i < model.node_count(); ++i)
    if (model.inverse_mass[uz(i)] == 0.0) held[uz(sets.root(i))] = 1;
  const std::vector<Resultant> sums = resultants(model, sets);
  for (Index i = 0; i < model.body_node_count(); ++i) {
    if (sets.root(i) != i || held[uz(i)] != 0) continue;
    if (sums[uz(i)].force.norm() > balanced * sums[uz(i)].size) refuse(scene, model, sets, i);
  }
}

}  // namespace sinew
