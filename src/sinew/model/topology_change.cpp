#include "sinew/model/topology_change.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "sinew/base/error.h"

namespace sinew {
namespace {

Vec3 angular_momentum(const Model& model, Range nodes, const State& state) {
  Vec3 sum = Vec3::Zero();
  for (Index i = nodes.begin; i < nodes.end; ++i)
    sum += model.mass[uz(i)] * state.position[uz(i)].cross(state.half_velocity[uz(i)]);
  return sum;
}

// Turns the velocities of the nodes about their centre of mass so that their angular momentum
// changes by `missing` and their momentum does not. Returns false if the nodes lie almost on a
// line: they would turn too fast.
bool turn(const Model& model, const std::vector<Index>& nodes, const Vec3& missing, State& state) {
  double mass = 0.0;
  Vec3 center = Vec3::Zero();
  for (const Index i : nodes) {
    mass += model.mass[uz(i)];
    center += model.mass[uz(i)] * state.position[uz(i)];
  }
  if (!(mass > 0.0)) return false;
  center /= mass;
  Mat3 inertia = Mat3::Zero();
  for (const Index i : nodes) {
    const Vec3 r = state.position[uz(i)] - center;
    inertia += model.mass[uz(i)] * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(inertia);
  if (!(axes.eigenvalues()[0] > 1e-3 * axes.eigenvalues()[2])) return false;
  const Vec3 spin = axes.eigenvectors() *
                    (axes.eigenvectors().transpose() * missing).cwiseQuotient(axes.eigenvalues());
  for (const Index i : nodes)
    state.half_velocity[uz(i)] += spin.cross(state.position[uz(i)] - center);
  return true;
}

// The free nodes of the body whose masses changed, with the new ones.
std::vector<Index> touched_nodes(const TopologyChange& change, const Model& before,
                                 const Model& after, std::size_t body) {
  std::vector<Index> nodes;
  const Range old = before.bodies[body].nodes;
  for (Index i = old.begin; i < old.end; ++i)
    if (after.mass[uz(change.node[uz(i)])] != before.mass[uz(i)])
      nodes.push_back(change.node[uz(i)]);
  for (const TopologyChange::NewNode& n : change.added)
    if (after.bodies[body].nodes.contains(n.node)) nodes.push_back(n.node);
  std::erase_if(nodes, [&](Index i) { return after.inverse_mass[uz(i)] == 0.0; });
  return nodes;
}

}  // namespace

State transfer_state(const TopologyChange& change, const Model& before, const Model& after,
                     const State& state) {
  if (before.version != change.from || after.version != change.from + 1 ||
      state.position.size() != before.rest_position.size() ||
      change.node.size() != before.rest_position.size() ||
      change.node.size() + change.added.size() != after.rest_position.size()) {
    throw Error(ErrorKind::usage,
                fmt::format("the change is one of version {} to {}, and the models are of versions "
                            "{} and {}, or the state has another number of nodes",
                            change.from, change.from + 1, before.version, after.version),
                "give the two models that the change lies between, and a state of the first");
  }
  State out = initial_state(after);
  out.last_step = state.last_step;
  out.time = state.time;
  out.step = state.step;
  out.energy = state.energy;
  out.obstacle_force = state.obstacle_force;
  out.position = change.carried(state.position);
  out.half_velocity = change.carried(state.half_velocity);
  for (ContactForce force : state.reactions.contacts) {
    if (force.id.kind != ContactKind::node_shape) continue;
    force.id.feature = force.node[0] = change.node[uz(force.id.feature)];
    out.reactions.contacts.push_back(force);
  }
  std::sort(out.reactions.contacts.begin(), out.reactions.contacts.end(),
            [](const ContactForce& a, const ContactForce& b) { return a.id < b.id; });
  return out;
}

void keep_angular_momentum(const TopologyChange& change, const Model& before, const State& old,
                           const Model& after, State& state) {
  for (std::size_t b = 0; b < before.bodies.size(); ++b) {
    const std::vector<Index> nodes = touched_nodes(change, before, after, b);
    if (nodes.empty()) continue;
    const Vec3 missing = angular_momentum(before, before.bodies[b].nodes, old) -
                         angular_momentum(after, after.bodies[b].nodes, state);
    if (turn(after, nodes, missing, state)) continue;
    std::vector<Index> all;
    for (Index i = after.bodies[b].nodes.begin; i < after.bodies[b].nodes.end; ++i)
      if (after.inverse_mass[uz(i)] > 0.0) all.push_back(i);
    turn(after, all, missing, state);
  }
}

}  // namespace sinew
