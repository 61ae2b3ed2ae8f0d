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

constexpr int most_ways = 20;  // recovery steps in one step of the stepper

// The bodies that are no longer tangled, and whether some of their tets are still inverted, though
// too few to count as tangled: with those the material would come to rest in a fold.
struct Righted {
  std::vector<Index> bodies;
  bool half = false;
};
Righted find_righted(const Model& model, std::span<const Index> were, const State& led) {
  const std::vector<LowTet> low = find_low_tets(model, led.position);
  const std::vector<Index> still = find_tangled(model, low);
  Righted righted;
  std::set_difference(were.begin(), were.end(), still.begin(), still.end(),
                      std::back_inserter(righted.bodies));
  for (const Index b : righted.bodies) {
    const Range tets = model.bodies[uz(b)].tets;
    righted.half = righted.half || std::any_of(low.begin(), low.end(), [&](const LowTet& tet) {
                     return tets.contains(tet.tet) && tet.volume <= 0.0;
                   });
  }
  return righted;
}

}  // namespace

// Minimisation finds the nearest fold, so the nodes of tangled bodies move as inversion recovery
// pulls them. The other nodes take an implicit step with these motions prescribed.
StepReport ImplicitStepper::lead_back(std::span<const Index> tangled, double h,
                                      const Controls& controls, const ImplicitOptions& options,
                                      State& state) {
  const auto energy_at = [&](const State& s) {
    return measure_energies(model_, controls, s, forces_.evaluate(controls, s).force).total();
  };
  const double energy = energy_at(state);
  State led = state;
  Righted righted;
  for (int way = 0; way < most_ways; ++way) {
    lead_tangled_bodies(model_, controls, h, tangled, led);
    lift_onto_planes(model_, controls, state.time + h, led.position);
    righted = find_righted(model_, tangled, led);
    if (!righted.half) break;
  }
  calm_bodies(model_, righted.bodies, led);

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
        if (plane.height(led.position[i]) > 1e-12 * led.position[i].norm()) continue;
        const double speed = plane.normal.dot(led.half_velocity[i]);
        led.half_velocity[i] -= std::min(0.0, speed) * plane.normal;
      }
      state.position[i] = led.position[i];
      state.half_velocity[i].setZero();
    }
  }
  state.reactions = {};
  StepReport report = ImplicitStepper(others).advance(h, controls, options, state);
  report.recovered = 1;
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    if (model_.inverse_mass[i] > others.inverse_mass[i]) {
      state.half_velocity[i] = led.half_velocity[i];
    }
  }
  state.reactions = {};
  state.energy.work_in += energy_at(state) - energy;
  return report;
}

}  // namespace sinew
