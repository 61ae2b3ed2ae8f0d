// The list of terms, and the sums of their energies and outer forces. A new force is one word in
// this list (docs/adding-a-force.md).
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "sinew/forces/grabs.h"
#include "sinew/forces/loads.h"
#include "sinew/forces/material_terms.h"
#include "sinew/forces/obstacles.h"
#include "sinew/forces/term.h"
#include "sinew/forces/ties.h"
#include "sinew/model/controls.h"
#include "sinew/model/state.h"

namespace sinew {

// All terms except those of the material and gravity. Forces, energies, products, the tangent
// matrix, the stable step, the joined bodies and the tests follow from this list.
using Terms = TypeList<TieTerm, LoadTerm, ObstacleTerm, GrabTerm>;

// The terms that the loops of a step compute together, with dashpots, viscosity and drag
// (forces/force_evaluator.h).
using FusedTerms = TypeList<SpringTerm, NetworkTerm, VolumeTerm, GravityTerm>;

// The configuration of a state.
inline Configuration configuration(const Model& model, const Controls& controls,
                                   const State& state) {
  return {model, controls, state.position, state.time};
}

// The velocity at the time of the positions, v(t) = (x(t+h) - x(t-h)) / 2h = w + a h / 2, with w
// the half-step velocity before t and h the last step. For nodes with a prescribed motion (pins) it
// is the half-step velocity. `force`: of all terms at the state [N] (nodes).
std::vector<Vec3> synchronous_velocity(const Model& model, const State& state,
                                       const std::vector<Vec3>& force);

// The energy stored in springs, network, volume and ties [J]; 0 at rest.
double elastic_energy(const Configuration& at);

// The energy that the rest state minimises [J]: elastic energy plus that of gravity, of the loads
// and obstacles at at.time and of the grabs; 0 at the rest positions. tet_volume: at at.x [m3]
// (tets), volumes_of_tets().
double potential_energy(const Configuration& at, std::span<const double> tet_volume);

// The forces of gravity, of the loads and obstacles at state.time, and of the grabs on the free
// nodes [N]; 0 on the others.
std::vector<Vec3> outer_forces(const Model& model, const Controls& controls, const State& state);

struct Energies {
  // [J] of the free nodes. After an explicit step sum m/2 w- . w+, with the half-step velocities
  // before and after the time of the positions: with it Verlet's method conserves the energy of a
  // linear body to rounding, at any step. m/2 v . v of the synchronous velocity v is larger by
  // m/8 (a h)^2.
  double kinetic = 0.0;
  double elastic = 0.0;     // [J] in springs, network and volume
  double gravity = 0.0;     // [J] of the free nodes, 0 at their rest positions
  double contact = 0.0;     // [J] between bodies and obstacles or grabs
  double dissipated = 0.0;  // [J] since the start
  double work_in = 0.0;     // [J] since the start
  // The energy account: kinetic + elastic + gravity + contact + dissipated - work_in is constant up
  // to the step's error. dissipated and work_in are those until the time of the positions: half of
  // the work of the step in progress is part of them.
  double total() const { return kinetic + elastic + gravity + contact + dissipated - work_in; }
  double largest_entry() const {
    return std::max({std::abs(kinetic), std::abs(elastic), std::abs(gravity), std::abs(contact),
                     std::abs(dissipated), std::abs(work_in)});
  }
};
// `force`: of all terms at the state [N] (nodes).
Energies measure_energies(const Model& model, const Controls& controls, const State& state,
                          const std::vector<Vec3>& force);

// Current volume of the body's tets divided by their rest volume [-].
double volume_ratio(const Model& model, const Body& body, const std::vector<Vec3>& x);

}  // namespace sinew
