#include "sinew/sim/readings.h"

#include <algorithm>

#include "sinew/forces/terms.h"
#include "sinew/mesh/tet_mesh.h"

namespace sinew {

std::vector<ProbeReading> read_probes(const Model& model, const std::vector<Vec3>& x) {
  std::vector<ProbeReading> readings;
  for (const Probe& probe : model.probes) {
    ProbeReading r;
    r.name = probe.name;
    Vec3 rest = Vec3::Zero();
    for (const Index node : probe.nodes) {
      r.position += x[uz(node)];
      rest += model.rest_position[uz(node)];
    }
    const auto count = static_cast<double>(probe.nodes.size());
    r.position /= count;
    r.displacement = r.position - rest / count;
    readings.push_back(std::move(r));
  }
  return readings;
}

bool holds_tissue(const Model& model, const Pin& pin) {
  return !pin.nodes.empty() && pin.nodes.front() < model.body_node_count();
}

std::vector<PinReading> read_pins(const Model& model, const Controls& controls, const State& state,
                                  const std::vector<Vec3>& force) {
  std::vector<Vec3> all = force;
  add_contact_forces(state, all);
  std::vector<PinReading> readings;
  for (const Pin& pin : model.pins) {
    if (!holds_tissue(model, pin)) continue;
    Vec3 center = Vec3::Zero();
    for (const Index node : pin.nodes) center += state.position[uz(node)];
    center /= static_cast<double>(pin.nodes.size());
    const ForceSum sum = load_on_pin(model, controls, state, all, pin, center);
    readings.push_back({pin.name, center, sum.force, sum.torque});
  }
  return readings;
}

Vec3 place_of(const ContactForce& c, const std::vector<Vec3>& x) {
  Vec3 place = Vec3::Zero();
  for (std::size_t a = 0; a < c.count(); ++a) place += c.weight[a] * x[uz(c.node[a])];
  return place;
}

void add_contact_forces(const State& state, std::vector<Vec3>& force) {
  for (const ContactForce& c : state.reactions.contacts)
    for (std::size_t a = 0; a < c.count(); ++a) force[uz(c.node[a])] += c.weight[a] * c.force;
}

ForceSum load_on_pin(const Model& model, const Controls& controls, const State& state,
                     const std::vector<Vec3>& force, const Pin& pin, const Vec3& about) {
  ForceSum sum{about};
  for (const Index node : pin.nodes)
    sum.add(state.position[uz(node)], force[uz(node)] + model.mass[uz(node)] * controls.gravity);
  return sum;
}

ForceSum load_on_obstacle(const State& state, Index obstacle, const Vec3& about) {
  ForceSum sum{about};
  for (const ContactForce& c : state.reactions.contacts)
    if (c.id.obstacle() == obstacle) sum.add(place_of(c, state.position), -c.force);
  return sum;
}

std::int64_t count_inverted(const Model& model, const std::vector<Vec3>& x) {
  return std::count_if(model.tets.begin(), model.tets.end(),
                       [&](const Tet& t) { return signed_volume(x, t) < 0.0; });
}

double volume_ratio(const Model& model, const std::vector<Vec3>& x) {
  double rest = 0.0;
  double volume = 0.0;
  for (const Body& body : model.bodies) {
    rest += body.rest_volume;
    volume += body.rest_volume * volume_ratio(model, body, x);
  }
  return rest > 0.0 ? volume / rest : 1.0;
}

}  // namespace sinew
