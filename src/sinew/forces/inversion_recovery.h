// Inversion recovery: the forces that replace those of the material while a body is tangled.
// docs/methods/inversion-recovery.md.
//
// No energy of a material pulls every state back to the rest shape: a fold in which no tet is
// inverted is a rest state too. A body with many inverted tets (at the start, or after an obstacle
// has torn through it) is outside the range of the material law. It is pulled back into that range:
// every node is pulled to its place in the body's rest shape, moved rigidly to fit the nodes best
// (shape matching, Mueller et al. 2005). This motion ends without inverted tets from any state.
#pragma once

#include <span>
#include <vector>

#include "sinew/forces/volume.h"
#include "sinew/model/controls.h"
#include "sinew/model/state.h"

namespace sinew {

// A body with volume terms is tangled when more than this share of its tets has v_t <= 0.
inline constexpr double tangled_share = 0.05;

// The bodies that are tangled, ascending. `low`: the tets near inversion (forces/volume.h).
std::vector<Index> find_tangled(const Model& model, std::span<const LowTet> low);

// The body's rest shape, moved rigidly: R X_i + c with the rotation R and the shift c that minimise
// sum_i w_i |x_i - R X_i - c|^2. The weights are the masses; nodes with a prescribed motion
// together weigh a million times the mass of the body. [m] (nodes of the body)
std::vector<Vec3> rest_shape_at(const Model& model, const Body& body, std::span<const Vec3> x);

// Moves the bodies to rest_shape_at(). Sets the positions of pinned nodes too.
void put_at_rest_shape(const Model& model, std::span<const Index> bodies, State& state);

// `force` [N] (nodes), at the state. On the free nodes of the tangled bodies the part of network
// and volume is replaced by  m w^2 (g_i - x_i) - 2 m w (v_i - v),  critically damped: g_i from
// rest_shape_at, v the body's mean velocity (0 if a node is pinned), w eight shear wave speeds per
// size of the body (more if the nodes fly apart faster), at most 0.3 / h. h: length of the step
// [s].
std::vector<Vec3> recovery_forces(const Model& model, const State& state, double h,
                                  std::span<const Index> tangled, std::vector<Vec3> force);

// The same force over a step of any length, in closed form: on the free nodes of the tangled bodies
// x = g + (d + c h) e^-wh + v h,  d = x - g,  c = (v_i - v) + w d, with no limit on w. A body
// without pinned nodes falls with gravity as a whole. Sets positions and velocities.
void advance_recovery(const Model& model, const Controls& controls, double h,
                      std::span<const Index> tangled, State& state);

// Removes the velocity of the recovery from these bodies: their free nodes get the mean velocity,
// or 0 if a node is pinned.
void remove_recovery_velocity(const Model& model, std::span<const Index> bodies, State& state);

}  // namespace sinew
