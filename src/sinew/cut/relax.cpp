#include "sinew/cut/relax.h"

#include "sinew/forces/terms.h"

namespace sinew {

double relax(const Model& model, const Controls& controls, double elastic_before, double h,
             ForceEvaluator& forces, State& state) {
  constexpr int most_steps = 100;
  double elastic = elastic_energy(configuration(model, controls, state));
  State still = state;  // no dashpot acts
  still.half_velocity.assign(still.half_velocity.size(), Vec3::Zero());
  for (int step = 0; step < most_steps && elastic > elastic_before; ++step) {
    const std::vector<Vec3>& force = forces.evaluate(controls, still).force;
    const std::vector<Vec3> outer = outer_forces(model, controls, still);
    for (std::size_t i = 0; i < force.size(); ++i)
      still.position[i] += 0.25 * h * h * model.inverse_mass[i] * (force[i] - outer[i]);
    elastic = elastic_energy(configuration(model, controls, still));
  }
  state.position = std::move(still.position);
  return elastic;
}

}  // namespace sinew
