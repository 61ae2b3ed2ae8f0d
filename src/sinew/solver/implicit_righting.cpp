// Implicit steps of a body that is tangled. docs/methods/righting.md.
#include <algorithm>

#include "sinew/base/parallel.h"
#include "sinew/contact/ground.h"
#include "sinew/forces/righting.h"
#include "sinew/forces/terms.h"
#include "sinew/solver/implicit.h"

namespace sinew {

// Minimising leads into the nearest fold, so the nodes of tangled bodies are given the way that
// righting pulls them; everything else takes its implicit step beside them.
ImplicitReport ImplicitStepper::lead_back(double h, const ImplicitOptions& options, State& state) {
  const double energy = measure_energies(model_, state, workspace_).total();
  State led = state;
  lead_tangled_bodies(model_, h, workspace_, led);
  if (model_.ground) lift_onto_ground(model_, led.position);

  Model others = model_;
  for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
    if (workspace_.tangled[b] == 0) continue;
    const Range nodes = model_.bodies[b].nodes;
    for (auto i = uz(nodes.begin); i < uz(nodes.end); ++i) {
      if (model_.inverse_mass[i] == 0.0) continue;
      others.inverse_mass[i] = 0.0;
      if (model_.ground && !(model_.ground->normal.dot(led.position[i] - model_.ground->point) >
                             1e-12 * led.position[i].norm())) {
        const double speed = model_.ground->normal.dot(led.half_velocity[i]);
        led.half_velocity[i] -= std::min(0.0, speed) * model_.ground->normal;
      }
      state.position[i] = led.position[i];
      state.half_velocity[i].setZero();
    }
  }
  state.reactions = {};
  ImplicitReport report = ImplicitStepper(others).advance(h, options, state);
  report.righted = 1;
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    if (model_.inverse_mass[i] > others.inverse_mass[i]) {
      state.half_velocity[i] = led.half_velocity[i];
    }
  }
  state.reactions = {};
  state.energy.work_in += measure_energies(model_, state, workspace_).total() - energy;
  return report;
}

}  // namespace sinew
