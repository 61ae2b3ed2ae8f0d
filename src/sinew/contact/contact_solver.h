// The contact solver of explicit steps: impulses with restitution and Coulomb friction.
// docs/methods/contact.md.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sinew/contact/contact.h"
#include "sinew/model/state.h"

namespace sinew {

struct ContactReport {
  Index contacts = 0;       // contacts with an impulse
  int sweeps = 0;           // Gauss-Seidel sweeps over all contacts
  double dissipated = 0.0;  // [J] by impact and friction
  double friction = 0.0;    // [J] of that by friction
  double work_in = 0.0;     // [J] by colliders that move, and `made`
  double made = 0.0;        // [J] by leading nodes out of surfaces, and by the error of the sweeps
  double deepest = 0.0;     // [m] the largest penetration that remains
};

// Scratch of solve_contacts(): the next step can recompute all of it.
struct ContactScratch {
  // A contact and its current impulses. "Along" means along the normal. Slots are indices into
  // `velocity`; unused slots are 0, which belongs to no node and has weight 0.
  struct Impact {
    std::array<std::uint32_t, 4> slot = {};
    std::array<double, 4> weight = {};     // [-]
    std::array<double, 4> share = {};      // weight / m: velocity change per impulse [1/kg]
    Vec3 normal = Vec3::Zero();            // [-]
    Vec3 speed = Vec3::Zero();             // of the collider's surface [m/s]
    Vec3 friction_impulse = Vec3::Zero();  // tangential impulse [N s]
    double impulse = 0.0;                  // normal impulse [N s]
    double mass = 0.0;                     // effective mass: 1 / sum_a weight_a^2 / m_a [kg]
    double least = 0.0;                    // smallest allowed velocity along [m/s]
    double friction = 0.0;                 // [-]
    int count = 0;                         // nodes used
  };
  // The part of a contact that the sweeps do not need.
  struct Arrival {
    const Contact* contact = nullptr;
    double velocity = 0.0;     // along, predicted [m/s]
    bool bounces = false;      // Impact::least is that of a bounce
    std::size_t recalled = 0;  // index of its force in the step before, or where it would be
    bool known = false;        // that force exists
  };
  std::vector<Impact> impacts;      // of contacts with a free node
  std::vector<Arrival> arrivals;    // (impacts)
  std::vector<Index> node;          // (slots)
  std::vector<Vec3> velocity;       // [m/s] (slots)
  std::vector<Vec3> predicted;      // [m/s] (slots)
  std::vector<Vec3> mean;           // of the velocities before and after the step [m/s] (slots)
  std::vector<std::uint32_t> slot;  // slot of a node, 0: no contact (nodes)
  std::vector<char> taken;          // 1: recalled (forces of the step before)
};

// Corrects a step of length h that violates the contacts. `state` holds the predicted positions and
// half-step velocities and, in last_step, the length of the step before; `force` is the force of
// the step [N] (nodes), `contacts` are the contacts at the predicted positions, sorted by
// comes_before(). `gravity` [m/s2], a part of the force, tells a bounce from rest.
//
// Each contact gets the impulse that ends the step with a gap of at least 0 and, if it closes, with
// at least the velocity of its bounce (contact/restitution.h), and a friction impulse of at most mu
// times that, against the sliding. Positions follow velocities, as for constraints in Verlet's
// method (SHAKE: Ryckaert, Ciccotti and Berendsen 1977), so the energy of a contact is the work of
// its impulse.
//
// Sweeps of projected Gauss-Seidel visit the contacts in order until the largest change is small. A
// contact with a gap above 0 takes part because other contacts may close it. The sweeps start from
// the forces of the step before, state.reactions.contacts (warm start); the new forces replace
// them. The impulses of a contact between bodies sum to zero: momentum is conserved to rounding.
//
// Adds the forces of the bodies on every obstacle to state.obstacle_force.
ContactReport solve_contacts(const Model& model, const std::vector<Contact>& contacts,
                             const std::vector<Vec3>& force, const Vec3& gravity, double h,
                             State& state, ContactScratch& scratch);

}  // namespace sinew
