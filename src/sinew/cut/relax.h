// The energy of a body that was cut.
#pragma once

#include "sinew/forces/force_evaluator.h"
#include "sinew/model/controls.h"
#include "sinew/model/model.h"
#include "sinew/model/state.h"
#include "sinew/model/topology_change.h"

namespace sinew {

// Splitting tets makes the cells smaller over which the network law averages the deformation, and
// the energy of an average is lower than the average of the energies: a cut would raise the elastic
// energy, by 0.01 to 5 %. It falls again when the lips give way to the stress that no longer
// crosses the cut. Steps of the steepest descent of the elastic energy in the metric of the masses,
//   x += h^2/4 M^-1 f,
// take the first part of that motion, without its speed, until the elastic energy is at most
// `target` [J]: that before the cut, less the fracture energy of a tear, which the elastic energy
// pays. One or two do for a cut in most cases. h [s] is the stable step, so the fastest mode
// ends in one step. Inner forces move no centre of mass. Returns the elastic energy [J]; it is
// higher than before if 100 steps do not suffice. `forces`: of the model.
//
// Where bodies touch each other, the lips do not pass through each other: the two nodes of a place
// that was doubled move apart, or stay together.
double relax(const Model& model, const Controls& controls, const TopologyChange& change,
             double target, double h, ForceEvaluator& forces, State& state);

}  // namespace sinew
