#include "sinew/model/topology_change.h"

#include <fmt/format.h>

#include <algorithm>

#include "sinew/base/error.h"

namespace sinew {

State transfer_state(const TopologyChange& change, const Model& before, const Model& after,
                     const State& state) {
  if (before.version != change.from || after.version != change.from + 1 ||
      state.position.size() != before.rest_position.size() ||
      change.node.size() != before.rest_position.size()) {
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
  for (std::size_t i = 0; i < change.node.size(); ++i) {
    if (change.node[i] < 0) continue;
    const auto n = uz(change.node[i]);
    out.position[n] = state.position[i];
    out.half_velocity[n] = state.half_velocity[i];
  }
  for (ContactForce force : state.reactions.contacts) {
    if (force.id.kind != ContactKind::node_shape) continue;
    const Index node = change.node[uz(force.id.feature)];
    if (node < 0) continue;
    force.id.feature = force.node[0] = node;
    out.reactions.contacts.push_back(force);
  }
  std::sort(out.reactions.contacts.begin(), out.reactions.contacts.end(),
            [](const ContactForce& a, const ContactForce& b) { return a.id < b.id; });
  return out;
}

}  // namespace sinew
