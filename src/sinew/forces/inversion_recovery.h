// Inversion recovery: the forces that replace those of the material while a body is tangled.
// docs/methods/inversion-recovery.md.
//
// No energy of a material leads back to the rest shape from everywhere: a fold in which every tet
// has its right side out is a rest state too. A body with many inverted tets (at the start, or
// after an obstacle has torn through it) is outside the range of the material law. It is led back
// into that range: every node is pulled to its place in the body's rest shape, moved rigidly to fit
// the nodes best (shape matching, Mueller et al. 2005). This leads straight from any state to one
// without inverted tets.
#pragma once

#include <span>
#include <vector>

#include "sinew/forces/volume.h"
#include "sinew/model/controls.h"
#include "sinew/model/state.h"

namespace sinew {

// A body with volume terms is tangled when more than this share of its tets has v_t <= 0.
inline constexpr double tangled_share = 0.05;

// The bodies that are tangled, rising. `low`: the tets near inversion (forces/volume.h).
std::vector<Index> find_tangled(const Model& model, std::span<const LowTet> low);

// The body's rest shape, moved rigidly: R X_i + c with the rotation R and the shift c that make
// sum_i w_i |x_i - R X_i - c|^2 smallest. Weights: the masses; nodes whose motion is given weigh a
// million times the rest together. [m] (nodes of the body)
std::vector<Vec3> rest_shape_at(const Model& model, const Body& body, std::span<const Vec3> x);

// Puts these bodies there. Sets positions, of held nodes too.
void put_at_rest_shape(const Model& model, std::span<const Index> bodies, State& state);

// `force` [N] (nodes), at the state, with the part of network and volume on the free nodes of the
// tangled bodies replaced by  m w^2 (g_i - x_i) - 2 m w (v_i - v),  critically damped: g_i from
// rest_shape_at, v the body's mean velocity (0 where it is held), w eight times what a shear wave
// takes to cross the body, at most 0.3 / h. h: length of the step [s].
std::vector<Vec3> recovery_forces(const Model& model, const State& state, double h,
                                  std::span<const Index> tangled, std::vector<Vec3> force);

// The same pull over a step of any length, in closed form: on the free nodes of the tangled bodies
// x = g + (d + c h) e^-wh + v h,  d = x - g,  c = (v_i - v) + w d, with w not limited; a body that
// nothing holds falls with gravity as a whole. Sets positions and velocities.
void lead_tangled_bodies(const Model& model, const Controls& controls, double h,
                         std::span<const Index> tangled, State& state);

// Takes the speed of the pull from these bodies: the mean velocity is left, or none where a node is
// held.
void calm_bodies(const Model& model, std::span<const Index> bodies, State& state);

}  // namespace sinew
