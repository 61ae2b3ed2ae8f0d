// Implicit steps of a body that is tangled. docs/methods/inversion-recovery.md.
#include <algorithm>

#include "sinew/base/parallel.h"
#include "sinew/contact/planes.h"
#include "sinew/forces/inversion_recovery.h"
#include "sinew/forces/stiffness.h"
#include "sinew/forces/terms.h"
#include "sinew/solver/implicit.h"

namespace sinew {
namespace {

constexpr int most_ways = 20;  // that are led at once

}  // namespace

// Whether some tets of a body that was tangled are inverted, though too few to call it so: with
// those, the material would rest in a fold. Says which bodies no longer are.
bool ImplicitStepper::half_righted(const State& led, std::vector<char>& righted) {
  const std::vector<char> was = workspace_.tangled;
  prepare_stiffness(model_, led.position, workspace_);
  find_tangled(model_, workspace_);
  righted.assign(was.size(), 0);
  bool half = false;
  for (std::size_t b = 0; b < was.size(); ++b) {
    if (was[b] == 0 || workspace_.tangled[b] != 0) continue;
    righted[b] = 1;
    const Range tets = model_.bodies[b].tets;
    for (auto t = uz(tets.begin); t < uz(tets.end); ++t) {
      half = half || workspace_.tet_volume[t] <= 0.0;
    }
  }
  workspace_.tangled = was;
  return half;
}

// Minimising leads into the nearest fold, so the nodes of tangled bodies are given the way that
// inversion recovery pulls them; everything else takes its implicit step beside them.
ImplicitReport ImplicitStepper::lead_back(double h, const Controls& controls,
                                          const ImplicitOptions& options, State& state) {
  const double energy = measure_energies(model_, controls, state, workspace_).total();
  State led = state;
  std::vector<char> righted;
  for (int way = 0; way < most_ways; ++way) {
    lead_tangled_bodies(model_, controls, h, workspace_, led);
    lift_onto_planes(model_, state.time + h, led.position);
    if (!half_righted(led, righted)) break;
  }
  calm_bodies(model_, righted, led);

  std::vector<HalfSpace> planes;
  for_each_hard_plane(model_, state.time + h,
                      [&](const HalfSpace& plane) { planes.push_back(plane); });
  Model others = model_;
  for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
    if (workspace_.tangled[b] == 0) continue;
    const Range nodes = model_.bodies[b].nodes;
    for (auto i = uz(nodes.begin); i < uz(nodes.end); ++i) {
      if (model_.inverse_mass[i] == 0.0) continue;
      others.inverse_mass[i] = 0.0;
      for (const HalfSpace& plane : planes) {
        if (plane.height(led.position[i]) > 1e-12 * led.position[i].norm()) continue;
        const double speed = plane.normal.dot(led.half_velocity[i]);
        led.half_velocity[i] -= std::min(0.0, speed) * plane.normal;
      }
      state.position[i] = led.position[i];
      state.half_velocity[i].setZero();
    }
  }
  state.reactions = {};
  ImplicitReport report = ImplicitStepper(others).advance(h, controls, options, state);
  report.righted = 1;
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    if (model_.inverse_mass[i] > others.inverse_mass[i]) {
      state.half_velocity[i] = led.half_velocity[i];
    }
  }
  state.reactions = {};
  state.energy.work_in += measure_energies(model_, controls, state, workspace_).total() - energy;
  return report;
}

}  // namespace sinew
