// The answer to contacts in an explicit step: impulses with restitution and Coulomb friction.
// docs/methods/contact.md.
#pragma once

#include <vector>

#include "sinew/contact/contact.h"
#include "sinew/model/state.h"

namespace sinew {

struct ContactReport {
  Index contacts = 0;       // places that touched
  double dissipated = 0.0;  // [J] by impact and friction
  double friction = 0.0;    // [J] of that by friction
  double work_in = 0.0;     // [J] by colliders that move
  double deepest = 0.0;     // [m] the deepest place that is left inside
};

// Corrects a step of length h that led into the contacts. `state` holds the predicted positions and
// half-step velocities and, in last_step, the step before this one; `force` is the force of the
// step [N] (nodes), `contacts` are those of the predicted positions.
//
// Every contact gets the impulse with which its gap does not end below 0, or the one of its rebound
// (contact/rebound.h), and at most mu times that along the plane, against the sliding. Positions
// follow velocities, as those of constraints do in Verlet's method (SHAKE: Ryckaert, Ciccotti and
// Berendsen 1977), so that what a contact does to the energy is what its impulse does. Contacts
// that share nodes are taken in turn, in their order, with their impulses so far (Gauss and
// Seidel), until what is left is small; those with a gap above 0 take part where the others would
// close it. The impulses of a contact between bodies add up to zero: momentum is kept to rounding.
//
// Adds what every collider is pushed with to state.obstacle_force.
ContactReport respond_to_contacts(const Model& model, const std::vector<Contact>& contacts,
                                  const std::vector<Vec3>& force, double h, State& state);

}  // namespace sinew
