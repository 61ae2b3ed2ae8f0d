#include "sinew/forces/terms.h"

#include "sinew/base/parallel.h"
#include "sinew/forces/heat.h"
#include "sinew/forces/network.h"
#include "sinew/forces/springs.h"
#include "sinew/forces/volume.h"
#include "sinew/mesh/tet_mesh.h"
#include "sinew/model/warm_start.h"

namespace sinew {

namespace {

// The energy of the terms of the given account [J].
double energy_of(Account account, const Configuration& at) {
  double sum = 0.0;
  for_each_type(Terms{}, [&](auto term) {
    if (term.account == account) sum += term.energy(at);
  });
  return sum;
}

double elastic_energy(const Configuration& at, std::span<const double> tet_volume) {
  return spring_energy(at.model, at.x) + network_energy(at.model, at.x) +
         energy_of(Account::elastic, at) + volume_energy(at.model, tet_volume) +
         edge_volume_energy(at.model, at.x);
}

// Half of the work of loads, pins, soft obstacles and tools in the explicit step that is in
// progress at the time of the positions [J]; 0 after other steps.
double work_in_progress(const Configuration& at, const State& state,
                        const std::vector<Vec3>& force) {
  if (state.last_step == 0.0) return 0.0;
  double work = 0.0;
  for_each_load_force(at.model, at.x, at.time, [&](Index node, const Vec3& load) {
    work += load.dot(state.half_velocity[uz(node)]);
  });
  for (const Pin& pin : at.model.pins) {
    for (const Index node : pin.nodes) work -= force[uz(node)].dot(state.half_velocity[uz(node)]);
  }
  work *= state.last_step;
  for_each_work_on_spheres(at, at.time - state.last_step, at.time,
                           [&](double of_one) { work -= of_one; });
  return 0.5 * work;
}

}  // namespace

std::vector<Vec3> synchronous_velocity(const Model& model, const State& state,
                                       const std::vector<Vec3>& force) {
  std::vector<Vec3> v(state.half_velocity);
  parallel_for(model.node_count(), [&](Index i) {
    const auto k = uz(i);
    v[k] += (0.5 * state.last_step * model.inverse_mass[k]) * force[k];
  });
  // Nodes at rest on a support are held by it.
  std::vector<NodeHold> holds;
  std::vector<Vec3> sum;
  warm_start(state, force, sum, holds);
  for (const NodeHold& hold : holds) {
    const auto k = uz(hold.node);
    v[k] += (0.5 * state.last_step * model.inverse_mass[k] * hold.share) * hold.force;
  }
  return v;
}

double elastic_energy(const Configuration& at) {
  return elastic_energy(at, volumes_of_tets(at.model, at.x));
}

std::vector<Vec3> outer_forces(const Model& model, const Controls& controls, const State& state) {
  std::vector<Vec3> f(model.rest_position.size(), Vec3::Zero());
  const Configuration at = configuration(model, controls, state);
  GravityTerm::add_forces(at, f);
  for_each_type(Terms{}, [&](auto term) {
    if (term.account != Account::elastic) term.add_forces(at, f);
  });
  return f;
}

double potential_energy(const Configuration& at, std::span<const double> tet_volume) {
  return elastic_energy(at, tet_volume) + (GravityTerm::energy(at) + energy_of(Account::work, at)) +
         energy_of(Account::contact, at);
}

Energies measure_energies(const Model& model, const Controls& controls, const State& state,
                          const std::vector<Vec3>& force) {
  const std::vector<Vec3>& w = state.half_velocity;
  Energies e;
  e.kinetic = parallel_sum(model.node_count(), [&](Index i) {
    const auto k = uz(i);
    // m w- . w+ with w+ = w- + h a. The contact forces of the step before are no part of it: the
    // contacts of the next step count their work whole (contact/contact_solver.cpp).
    return model.inverse_mass[k] > 0.0
               ? 0.5 * w[k].dot(model.mass[k] * w[k] + state.last_step * force[k])
               : 0.0;
  });
  const Configuration at = configuration(model, controls, state);
  e.gravity = GravityTerm::energy(at) + energy_of(Account::gravity, at);
  e.elastic = elastic_energy(at);
  e.contact = energy_of(Account::contact, at);
  const double half = 0.5 * state.last_step;
  e.dissipated = state.energy.dissipated + half * damping_power(model, state.position, w, w);
  e.work_in = state.energy.work_in + work_in_progress(at, state, force);
  return e;
}

double volume_ratio(const Model& model, const Body& body, const std::vector<Vec3>& x) {
  const double volume = parallel_sum(body.tets.size(), [&](Index i) {
    return signed_volume(x, model.tets[static_cast<std::size_t>(body.tets.begin + i)]);
  });
  return volume / body.rest_volume;
}

}  // namespace sinew
