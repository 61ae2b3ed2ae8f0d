#include "sinew/forces/springs.h"

#include "sinew/base/parallel.h"
#include "sinew/forces/spring_law.h"

namespace sinew {

double compute_spring_forces(const Model& model, const State& state, std::vector<Vec3>& force) {
  force.resize(model.springs.size());
  double power = 0.0;
  for (const Range& active : model.active_springs) {
    power += parallel_reduce(
        active.size(), 0.0,
        [&](Range r) {
          double heat = 0.0;
          for (Index i = r.begin; i < r.end; ++i) {
            const auto s = uz(active.begin + i);
            const auto a = uz(model.springs[s][0]);
            const auto c = uz(model.springs[s][1]);
            const Vec3 x_ij = state.position[c] - state.position[a];
            const Vec3 v_ij = state.half_velocity[c] - state.half_velocity[a];
            const double k = model.stiffness[s];
            const SpringForce spring =
                k == 0.0 ? dashpot_force(x_ij, v_ij, model.damping[s])
                         : spring_force(x_ij, v_ij, k, model.rest_length[s], model.damping[s]);
            force[s] = spring.force;
            heat += spring.heat;
          }
          return heat;
        },
        [](double x, double y) { return x + y; });
  }
  return power;
}

double spring_energy(const Model& model, std::span<const Vec3> x) {
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

}  // namespace sinew
