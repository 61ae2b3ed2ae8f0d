#include "sinew/forces/springs.h"

#include "sinew/base/parallel.h"
#include "sinew/forces/spring_law.h"

namespace sinew {

Workspace::Workspace(const Model& model)
    : spring_force(model.springs.size(), Vec3::Zero()),
      force(model.rest_position.size(), Vec3::Zero()) {}

double compute_spring_forces(const Model& model, const State& state, Workspace& workspace) {
  const Index n = model.spring_count();
  workspace.partial.assign(static_cast<std::size_t>(block_count(n)), 0.0);
  parallel_blocks(n, [&](Index b, Range r) {
    double power = 0.0;
    for (Index i = r.begin; i < r.end; ++i) {
      const auto s = uz(i);
      const auto a = static_cast<std::size_t>(model.springs[s][0]);
      const auto c = static_cast<std::size_t>(model.springs[s][1]);
      const Vec3 x_ij = state.position[c] - state.position[a];
      const Vec3 v_ij = state.half_velocity[c] - state.half_velocity[a];
      const SpringPull pull =
          spring_pull(x_ij, v_ij, model.stiffness[s], model.rest_length[s], model.damping[s]);
      workspace.spring_force[s] = pull.force;
      power += pull.heat;
    }
    workspace.partial[uz(b)] = power;
  });
  double power = 0.0;
  for (const double p : workspace.partial) power += p;
  return power;
}

double elastic_energy(const Model& model, std::span<const Vec3> x) {
  return parallel_sum(model.spring_count(), [&](Index i) {
    const auto s = uz(i);
    const Vec3 x_ij = x[static_cast<std::size_t>(model.springs[s][1])] -
                      x[static_cast<std::size_t>(model.springs[s][0])];
    return spring_energy(x_ij, model.stiffness[s], model.rest_length[s]);
  });
}

StretchRange measure_stretch(const Model& model, std::span<const Vec3> x) {
  StretchRange range;
  for (Index i = 0; i < model.first_attachment; ++i) {
    const auto s = uz(i);
    const Vec3 x_ij = x[static_cast<std::size_t>(model.springs[s][1])] -
                      x[static_cast<std::size_t>(model.springs[s][0])];
    const double stretch = x_ij.norm() / model.rest_length[s] - 1.0;
    if (stretch > range.stretch) {
      range.stretch = stretch;
      range.longest = i;
    }
    if (-stretch > range.compress) {
      range.compress = -stretch;
      range.shortest = i;
    }
  }
  return range;
}

void stiffness_damping_times(const Model& model, std::span<const Vec3> x, double a, double b,
                             std::span<const Vec3> u, Workspace& workspace, std::span<Vec3> out) {
  parallel_for(model.spring_count(), [&](Index i) {
    const auto s = uz(i);
    const auto n0 = static_cast<std::size_t>(model.springs[s][0]);
    const auto n1 = static_cast<std::size_t>(model.springs[s][1]);
    const Vec3 x_ij = x[n1] - x[n0];
    const Vec3 u_ij = u[n1] - u[n0];
    workspace.spring_force[s] =
        a * spring_stiffness_times(x_ij, model.stiffness[s], model.rest_length[s], u_ij, true) +
        b * dashpot_times(x_ij, model.damping[s], u_ij);
  });
  parallel_for(model.node_count(), [&](Index i) {
    const auto n = uz(i);
    out[n] = Vec3::Zero();
    if (model.inverse_mass[n] > 0.0) {
      out[n] = b * model.drag[n] * model.mass[n] * u[n] - gather_springs(model, workspace, i);
    }
  });
}

}  // namespace sinew
