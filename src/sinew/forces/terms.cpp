#include "sinew/forces/terms.h"

#include "sinew/base/parallel.h"
#include "sinew/forces/network.h"
#include "sinew/forces/node_kernels.h"
#include "sinew/forces/packed.h"
#include "sinew/forces/springs.h"
#include "sinew/forces/viscosity.h"
#include "sinew/forces/volume.h"
#include "sinew/mesh/tet_mesh.h"
#include "sinew/model/warm_start.h"

namespace sinew {

namespace {

// Energy of the terms of that account [J].
double energy_of(Account account, const Configuration& at) {
  double sum = 0.0;
  for_each_type(Terms{}, [&](auto term) {
    if (term.account == account) sum += term.energy(at);
  });
  return sum;
}

}  // namespace

double compute_forces(const Model& model, const Controls& controls, const State& state,
                      Workspace& workspace) {
  double power = 0.0;
  const bool viscous = !model.tet_viscosity.empty();
  if (viscous) {
    power += compute_viscous_forces(model, state.position, state.half_velocity, workspace);
  }
  if (workspace.packed) {
    PackedForces& packed = *workspace.packed;
    power += packed.compute(model, state);
    compute_tet_geometry(model, state.position, packed.low_tets(), workspace);
    workspace.has_tets = false;
    workspace.partial.assign(uz(packed.patch_count()), 0.0);
    packed.for_each_patch([&](Index patch, std::span<const Index> nodes, const float* force) {
      workspace.partial[uz(patch)] = add_gravity_and_drag(
          model, controls.gravity, state.half_velocity, nodes, force, workspace.force);
    });
  } else {
    power += compute_spring_forces(model, state, workspace);
    if (model.has_volume) compute_volume_pressures(model, state.position, workspace);
    const bool network = !model.network_start.empty();
    workspace.partial.assign(uz(block_count(model.node_count())), 0.0);
    parallel_blocks(model.node_count(), [&](Index b, Range r) {
      for (Index i = r.begin; i < r.end; ++i) {
        Vec3 f = gather_springs(model, workspace, i);
        if (network) f += network_pull(model, state.position, i);
        if (model.has_volume) f += push_of_tets(model, workspace, i);
        workspace.force[uz(i)] = f;
      }
      workspace.partial[uz(b)] =
          add_gravity_and_drag(model, controls.gravity, state.half_velocity, r, workspace.force);
    });
  }
  if (viscous) {
    parallel_for(model.node_count(),
                 [&](Index i) { workspace.force[uz(i)] += gather_viscous(model, workspace, i); });
  }
  for (const double p : workspace.partial) power += p;

  const Configuration at = configuration(model, controls, state);
  for_each_type(Terms{}, [&](auto term) { term.add_forces(at, workspace.force); });
  return power;
}

std::vector<Vec3> synchronous_velocity(const Model& model, const State& state,
                                       const Workspace& workspace) {
  std::vector<Vec3> v(state.half_velocity);
  parallel_for(model.node_count(), [&](Index i) {
    const auto k = uz(i);
    v[k] += (0.5 * state.last_step * model.inverse_mass[k]) * workspace.force[k];
  });
  // What rests on something is held by it.
  std::vector<NodeHold> held;
  std::vector<Vec3> sum;
  warm_start(state, workspace.force, sum, held);
  for (const NodeHold& hold : held) {
    const auto k = uz(hold.node);
    v[k] += (0.5 * state.last_step * model.inverse_mass[k] * hold.share) * hold.push;
  }
  return v;
}

double elastic_energy(const Configuration& at, Workspace& workspace) {
  return spring_energy(at.model, at.x) + network_energy(at.model, at.x) +
         energy_of(Account::elastic, at) + volume_energy(at.model, at.x, workspace);
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

double potential_energy(const Model& model, const Controls& controls, const State& state,
                        Workspace& workspace) {
  const Configuration at = configuration(model, controls, state);
  return elastic_energy(at, workspace) + (GravityTerm::energy(at) + energy_of(Account::work, at)) +
         energy_of(Account::contact, at);
}

Energies measure_energies(const Model& model, const Controls& controls, const State& state,
                          Workspace& workspace) {
  compute_forces(model, controls, state, workspace);
  if (model.has_volume && !workspace.has_tets) {
    compute_pressures(model, state.position, workspace);
  }
  const std::vector<Vec3> v = synchronous_velocity(model, state, workspace);
  Energies e;
  e.kinetic = parallel_sum(model.node_count(), [&](Index i) {
    const auto k = uz(i);
    return model.inverse_mass[k] > 0.0 ? 0.5 * model.mass[k] * v[k].squaredNorm() : 0.0;
  });
  const Configuration at = configuration(model, controls, state);
  e.gravity = GravityTerm::energy(at) + energy_of(Account::gravity, at);
  e.elastic = elastic_energy(at, workspace);
  e.contact = energy_of(Account::contact, at);
  e.dissipated = state.energy.dissipated;
  e.work_in = state.energy.work_in;
  return e;
}

double volume_ratio(const Model& model, const Body& body, const std::vector<Vec3>& x) {
  const double volume = parallel_sum(body.tets.size(), [&](Index i) {
    return signed_volume(x, model.tets[static_cast<std::size_t>(body.tets.begin + i)]);
  });
  return volume / body.rest_volume;
}

}  // namespace sinew
