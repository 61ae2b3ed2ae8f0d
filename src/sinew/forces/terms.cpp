#include "sinew/forces/terms.h"

#include "sinew/base/parallel.h"
#include "sinew/forces/loads.h"
#include "sinew/forces/network.h"
#include "sinew/forces/node_kernels.h"
#include "sinew/forces/obstacles.h"
#include "sinew/forces/packed.h"
#include "sinew/forces/springs.h"
#include "sinew/forces/tethers.h"
#include "sinew/forces/ties.h"
#include "sinew/forces/viscosity.h"
#include "sinew/forces/volume.h"
#include "sinew/mesh/tet_mesh.h"
#include "sinew/model/warm_start.h"

namespace sinew {

namespace {

// Minus the work of gravity and loads on the free nodes since the rest positions [J].
double outer_potential(const Model& model, const State& state) {
  const double gravity = parallel_sum(model.node_count(), [&](Index i) {
    const auto k = uz(i);
    if (model.inverse_mass[k] == 0.0) return 0.0;
    return -model.mass[k] * model.gravity.dot(state.position[k] - model.rest_position[k]);
  });
  return gravity + load_potential(model, state.position, state.time, 1.0);
}

}  // namespace

double compute_forces(const Model& model, const State& state, Workspace& workspace) {
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
      workspace.partial[uz(patch)] =
          add_gravity_and_drag(model, state.half_velocity, nodes, force, workspace.force);
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
          add_gravity_and_drag(model, state.half_velocity, r, workspace.force);
    });
  }
  if (viscous) {
    parallel_for(model.node_count(),
                 [&](Index i) { workspace.force[uz(i)] += gather_viscous(model, workspace, i); });
  }
  for (const double p : workspace.partial) power += p;

  add_tie_forces(model, state.position, workspace.force);
  add_load_forces(model, state.position, state.time, 1.0, workspace.force);
  add_obstacle_forces(model, state.position, state.time, workspace.force);
  add_tether_forces(model, state.position, workspace.force);
  workspace.obstacle_center = obstacle_centers(model, state.time);
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

double elastic_energy(const Model& model, std::span<const Vec3> x, Workspace& workspace) {
  return spring_energy(model, x) + network_energy(model, x) + tie_energy(model, x) +
         volume_energy(model, x, workspace);
}

std::vector<Vec3> outer_forces(const Model& model, const State& state) {
  std::vector<Vec3> f(model.rest_position.size(), Vec3::Zero());
  parallel_for(model.node_count(), [&](Index i) {
    if (model.inverse_mass[uz(i)] > 0.0) f[uz(i)] = model.mass[uz(i)] * model.gravity;
  });
  add_load_forces(model, state.position, state.time, 1.0, f);
  add_obstacle_forces(model, state.position, state.time, f);
  add_tether_forces(model, state.position, f);
  return f;
}

double potential_energy(const Model& model, const State& state, Workspace& workspace) {
  return elastic_energy(model, state.position, workspace) + outer_potential(model, state) +
         obstacle_energy(model, state.position, state.time) + tether_energy(model, state.position);
}

Energies measure_energies(const Model& model, const State& state, Workspace& workspace) {
  compute_forces(model, state, workspace);
  if (model.has_volume && !workspace.has_tets) {
    compute_pressures(model, state.position, workspace);
  }
  const std::vector<Vec3> v = synchronous_velocity(model, state, workspace);
  Energies e;
  e.kinetic = parallel_sum(model.node_count(), [&](Index i) {
    const auto k = uz(i);
    return model.inverse_mass[k] > 0.0 ? 0.5 * model.mass[k] * v[k].squaredNorm() : 0.0;
  });
  e.gravity = parallel_sum(model.node_count(), [&](Index i) {
    const auto k = uz(i);
    if (model.inverse_mass[k] == 0.0) return 0.0;
    return -model.mass[k] * model.gravity.dot(state.position[k] - model.rest_position[k]);
  });
  e.elastic = elastic_energy(model, state.position, workspace);
  e.contact =
      obstacle_energy(model, state.position, state.time) + tether_energy(model, state.position);
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
