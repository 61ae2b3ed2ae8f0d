// The contact solver of explicit steps: impulses with restitution and Coulomb friction.
// docs/methods/contact.md.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sinew/contact/contact.h"
#include "sinew/contact/restitution.h"
#include "sinew/model/state.h"

namespace sinew {

struct ContactReport {
  Index contacts = 0;       // places that touched
  int sweeps = 0;           // Gauss-Seidel sweeps over all contacts
  double dissipated = 0.0;  // [J] by impact and friction
  double friction = 0.0;    // [J] of that by friction
  double work_in = 0.0;     // [J] by colliders that move
  double deepest = 0.0;     // [m] the deepest place that is left inside
};

// Scratch of solve_contacts(): the next step can compute all of it again.
struct ContactScratch {
  // A contact and its impulses so far. "Along" is along the normal. Slots are into `velocity`;
  // those that are not used are 0, which is nobody's and has no weight.
  struct Impact {
    std::array<std::uint32_t, 4> slot = {};
    std::array<double, 4> weight = {};  // [-]
    std::array<double, 4> share = {};   // weight / m, what an impulse changes velocities by [1/kg]
    Vec3 normal = Vec3::Zero();         // [-]
    Vec3 speed = Vec3::Zero();          // of the collider's surface [m/s]
    Vec3 grip = Vec3::Zero();           // across [N s]
    double impulse = 0.0;               // along [N s]
    double mass = 0.0;                  // effective: 1 / sum_a weight_a^2 / m_a [kg]
    double least = 0.0;                 // along, velocity to go on with [m/s]
    double friction = 0.0;              // [-]
    int count = 0;                      // of nodes
  };
  // The part of a contact that the sweeps do not need.
  struct Arrival {
    const Contact* contact = nullptr;
    double velocity = 0.0;  // along, as predicted [m/s]
    double pull = 0.0;      // along, acceleration [m/s2]; of what may bounce
    bool bounces = false;   // as `after` has it
    Rebound after;
    std::size_t recalled = 0;  // where its push of the step before is, or would be
    bool known = false;        // it is there
  };
  std::vector<Impact> impacts;      // of those that can be pushed
  std::vector<Arrival> arrivals;    // (impacts)
  std::vector<Index> node;          // (slots)
  std::vector<Vec3> velocity;       // [m/s] (slots)
  std::vector<Vec3> predicted;      // [m/s] (slots)
  std::vector<Vec3> mean;           // of the velocities before and after the step [m/s] (slots)
  std::vector<std::uint32_t> slot;  // of a node, 0: not touched (nodes)
  std::vector<char> taken;          // 1: recalled (pushes of the step before)
};

// Corrects a step of length h that led into the contacts. `state` holds the predicted positions and
// half-step velocities and, in last_step, the step before this one; `force` is the force of the
// step [N] (nodes), `contacts` are those of the predicted positions, sorted by comes_before().
//
// Each contact gets the impulse that ends the step with a gap of at least 0, or that of its rebound
// (contact/restitution.h), and a friction impulse of at most mu times that, against the sliding.
// Positions follow velocities, as constraints do in Verlet's method (SHAKE: Ryckaert, Ciccotti and
// Berendsen 1977), so the energy of a contact is the work of its impulse.
//
// Sweeps of projected Gauss-Seidel take the contacts in their order until the largest change is
// small. A contact with a gap above 0 takes part because others may close it. The sweeps start from
// the forces of the step before, state.reactions.contacts (warm start); the new forces replace
// them. The impulses of a contact between bodies sum to zero: momentum is kept to rounding.
//
// Adds the forces of the bodies on every obstacle to state.obstacle_force.
ContactReport solve_contacts(const Model& model, const std::vector<Contact>& contacts,
                             const std::vector<Vec3>& force, double h, State& state,
                             ContactScratch& scratch);

}  // namespace sinew
