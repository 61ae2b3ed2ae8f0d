// Implicit steps of a tangled body. docs/methods/inversion-recovery.md.
#include <algorithm>
#include <iterator>

#include "sinew/base/parallel.h"
#include "sinew/contact/planes.h"
#include "sinew/forces/inversion_recovery.h"
#include "sinew/forces/terms.h"
#include "sinew/solver/implicit.h"

namespace sinew {
namespace {

constexpr int most_recovery_steps = 20;  // in one step of the stepper

// The bodies that are no longer tangled, and whether some of their tets are still inverted, though
// too few to count as tangled: with those the material would come to rest in a fold.
struct Recovered {
  std::vector<Index> bodies;
  bool still_inverted = false;
};
Recovered find_recovered(const Model& model, std::span<const Index> were, const State& moved) {
  const std::vector<LowTet> low = find_low_tets(model, moved.position);
  const std::vector<Index> still = find_tangled(model, low);
  Recovered recovered;
  std::set_difference(were.begin(), were.end(), still.begin(), still.end(),
                      std::back_inserter(recovered.bodies));
  for (const Index b : recovered.bodies) {
    const Range tets = model.bodies[uz(b)].tets;
    recovered.still_inverted =
        recovered.still_inverted || std::any_of(low.begin(), low.end(), [&](const LowTet& tet) {
          return tets.contains(tet.tet) && tet.volume <= 0.0;
        });
  }
  return recovered;
}

}  // namespace

// Minimisation finds the nearest fold, so the nodes of tangled bodies move as inversion recovery
// pulls them. The other nodes take an implicit step with these motions prescribed.
StepReport ImplicitStepper::recover(std::span<const Index> tangled, double h,
                                    const Controls& controls, const ImplicitOptions& options,
                                    State& state) {
  const auto energy_at = [&](const State& s) {
    return measure_energies(model_, controls, s, forces_.evaluate(controls, s).force).total();
  };
  const double energy = energy_at(state);
  const State start = state;
  State moved = state;
  Recovered recovered;
  for (int n = 0; n < most_recovery_steps; ++n) {
    advance_recovery(model_, controls, h, tangled, moved);
    lift_onto_planes(model_, controls, state.time + h, moved.position);
    recovered = find_recovered(model_, tangled, moved);
    if (!recovered.still_inverted) break;
  }
  remove_recovery_velocity(model_, recovered.bodies, moved);

  std::vector<HalfSpace> planes;
  for_each_hard_plane(model_, controls, state.time + h,
                      [&](const HalfSpace& plane) { planes.push_back(plane); });
  Model others = model_;
  for (const Index b : tangled) {
    const Range nodes = model_.bodies[uz(b)].nodes;
    for (auto i = uz(nodes.begin); i < uz(nodes.end); ++i) {
      if (model_.inverse_mass[i] == 0.0) continue;
      others.inverse_mass[i] = 0.0;
      for (const HalfSpace& plane : planes) {
        if (plane.height(moved.position[i]) > 1e-12 * moved.position[i].norm()) continue;
        const double speed = plane.normal.dot(moved.half_velocity[i]);
        moved.half_velocity[i] -= std::min(0.0, speed) * plane.normal;
      }
      state.position[i] = moved.position[i];
      state.half_velocity[i].setZero();
    }
  }
  state.reactions = {};
  StepReport report = ImplicitStepper(others).advance(h, controls, options, state);
  if (report.stopped) {
    state = start;
    return report;
  }
  report.recovered = 1;
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    if (model_.inverse_mass[i] > others.inverse_mass[i]) {
      state.half_velocity[i] = moved.half_velocity[i];
    }
  }
  state.reactions = {};
  report.recovery_work = energy_at(state) - energy;
  state.energy.work_in += report.recovery_work;
  return report;
}

}  // namespace sinew
