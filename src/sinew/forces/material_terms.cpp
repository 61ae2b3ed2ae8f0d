#include "sinew/forces/material_terms.h"

#include "sinew/base/parallel.h"
#include "sinew/forces/network.h"
#include "sinew/forces/springs.h"
#include "sinew/forces/volume.h"

namespace sinew {

double SpringTerm::energy(const Configuration& at) {
  return spring_energy(at.model, at.x);
}

void SpringTerm::add_forces(const Configuration& at, std::span<Vec3> forces) {
  for (std::size_t s = 0; s < at.model.springs.size(); ++s) {
    const auto [i, j] = at.model.springs[s];
    const Vec3 force = spring_force(at.x[uz(j)] - at.x[uz(i)], Vec3::Zero(), at.model.stiffness[s],
                                    at.model.rest_length[s], 0.0)
                           .force;
    forces[uz(i)] += force;
    forces[uz(j)] -= force;
  }
}

double NetworkTerm::energy(const Configuration& at) {
  return network_energy(at.model, at.x);
}

void NetworkTerm::add_forces(const Configuration& at, std::span<Vec3> forces) {
  if (at.model.network_start.empty()) return;
  for (Index i = 0; i < at.model.node_count(); ++i)
    forces[uz(i)] += network_force(at.model, at.x, i);
}

double VolumeTerm::energy(const Configuration& at) {
  return volume_energy(at.model, volumes_of_tets(at.model, at.x)) +
         edge_volume_energy(at.model, at.x);
}

void VolumeTerm::add_forces(const Configuration& at, std::span<Vec3> forces) {
  if (!at.model.has_volume) return;
  const TetState tets = compute_tet_state(at.model, at.x);
  for (Index i = 0; i < at.model.node_count(); ++i)
    forces[uz(i)] += volume_force(at.model, tets, i);
}

double GravityTerm::energy(const Configuration& at) {
  return parallel_sum(at.model.node_count(), [&](Index i) {
    const auto k = uz(i);
    if (at.model.inverse_mass[k] == 0.0) return 0.0;
    return -at.model.mass[k] * at.controls.gravity.dot(at.x[k] - at.model.rest_position[k]);
  });
}

void GravityTerm::add_forces(const Configuration& at, std::span<Vec3> forces) {
  parallel_for(at.model.node_count(), [&](Index i) {
    if (at.model.inverse_mass[uz(i)] > 0.0)
      forces[uz(i)] += at.model.mass[uz(i)] * at.controls.gravity;
  });
}

VolumeParts::VolumeParts(const Configuration& at) {
  const Model& m = at.model;
  if (!m.has_volume) return;
  TetState tets = compute_tet_state(m, at.x);
  for (std::size_t t = 0; t < m.tets.size(); ++t)
    stiffness.push_back(tet_volume_stiffness(m, t, tets.volume[t]) / m.rest_volume[t]);
  edges = std::move(tets.edges);
  pressure = std::move(tets.pressure);
  gradient = std::move(tets.gradient);
  for (std::size_t c = 0; c < m.cell_volume.size(); ++c) {
    Cell cell;
    cell.stiffness = m.cell_bulk[c] / m.cell_volume[c];
    for (auto k = uz(m.cell_start[c]); k < uz(m.cell_start[c + 1]); ++k) {
      const auto t = uz(m.cell_tet[k]);
      for (std::size_t a = 0; a < 4; ++a) {
        cell.nodes.push_back(m.tets[t][a]);
        cell.gradient.push_back(m.cell_weight[k] * gradient[t][a]);
      }
    }
    cells.push_back(std::move(cell));
  }
}

}  // namespace sinew
