// Contact of nodes with the ground: restitution and Coulomb friction. docs/methods/ground.md.
#pragma once

#include <vector>

#include "sinew/model/state.h"

namespace sinew {

struct GroundReport {
  Index contacts = 0;       // nodes that touched the ground in this step
  double dissipated = 0.0;  // [J] by impact and friction
};

// Corrects the nodes that a step of length h has taken below the ground. `state` holds the
// predicted positions and half-step velocities and, in last_step, the step before this one; `force`
// is the force of the step [N] (nodes).
//
// Within a step the acceleration is constant and a node flies on a parabola; the moment at which
// it meets the plane is exact, so a ball that bounces with restitution 1 keeps its height. A node
// that would land again within the step is at rest on the plane. Friction takes at most mu times
// the normal impulse from the tangential velocity.
GroundReport respond_to_ground(const Model& model, const std::vector<Vec3>& force, double h,
                               State& state);

// Lifts nodes below the plane onto it: keeps limits and ground both true. Returns how many.
Index lift_onto_ground(const Model& model, std::vector<Vec3>& x);

}  // namespace sinew
