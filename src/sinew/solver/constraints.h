// Contacts with friction, strain limits and volume limits as part of the objective of implicit
// steps and rest states. docs/methods/constraints.md.
#pragma once

#include <span>
#include <vector>

#include "sinew/forces/volume.h"
#include "sinew/model/controls.h"
#include "sinew/model/state.h"
#include "sinew/solver/contact_constraints.h"

namespace sinew {

// The errors of constraints and friction, as multiples of their tolerances: at most 1 if they hold.
struct ConstraintError {
  double distance = 0.0;  // largest change of a force over k: a distance past the bound
  double friction = 0.0;  // change of the normal forces that bound friction, relative to their sum
  double changed_contacts = 0.0;  // the error due to contacts that were found again
};

// Constraints on
//   the gap of each contact (contact_constraints.h)     gap >= 0, with friction
//   the length of each limited spring                   (1 - tau_c) l0 <= l <= (1 + tau_s) l0
//   the volume of each limited cell                     |V - V_c| <= limit V_c
// each as an energy of solver/bound.h. minimise() finds the positions for given multipliers;
// update() takes the forces found as the new multipliers, until they do not change any more
// (minimise_augmented_lagrangian). The ground is a plane obstacle, so its contacts are among the
// contacts.
//
// The stiffness k of a constraint on q is three times the resistance of its single nodes,
// 1 / sum_i (|dq/dx_i|^2 / D_i) with D_i the diagonal of M inertia + C rate + K. This bounds the
// share of the error that a pass leaves, and does not worsen the condition of the tangent.
class Constraints {
 public:
  // inertia [1/s2] and rate [1/s] as in Objective. friction: whether contacts have friction.
  Constraints(const Model& model, double inertia, double rate, bool friction);

  bool empty() const;

  // Takes the multipliers of the state's last step. `from`: the positions at the start of the step
  // of length `step` [s], from which slips are measured [m] (nodes); a reference is kept; may be
  // null without friction.
  void start(const Controls& controls, const State& state, const std::vector<Vec3>* from,
             double step);

  // --- the energy for the current multipliers; the tets are those at x ---

  double value(const std::vector<Vec3>& x, std::span<const double> tet_volume) const;  // [J]
  // Adds the forces [N] to `force` (nodes).
  void add_forces(const std::vector<Vec3>& x, const TetVolumes& tets,
                  std::vector<Vec3>& force) const;

  // Adds the forces of the multipliers alone, along the directions at x (nodes).
  void add_reactions(const std::vector<Vec3>& x, const TetVolumes& tets,
                     std::vector<Vec3>& force) const;

  // Computes the second derivative at x for the functions below.
  void linearise(const std::vector<Vec3>& x, const TetVolumes& tets);
  // out += H u, rows of the free nodes, without the part of tet_pressure().
  void add_stiffness_times(const TetVolumes& tets, const std::vector<Vec3>& u,
                           std::vector<Vec3>& out) const;

  // The results of linearise(): for every limited spring k n n^T + a (1 - n n^T) between its ends;
  // for every cell k dV dV^T. Contacts: contact_constraints().tangents().
  struct SpringTangent {
    Vec3 direction = Vec3::Zero();  // n
    double along = 0.0;             // k [N/m]
    double across = 0.0;            // a [N/m]
  };
  const std::vector<SpringTangent>& spring_tangents() const { return spring_tangent_; }
  const std::vector<double>& cell_stiffness() const { return cell_tangent_; }  // [N/m5]
  // The pressure of the limited cells on each tet [Pa] (tets); empty without such cells. It acts by
  // the curvature of the tets' volumes, like the material's own pressure.
  const std::vector<double>& tet_pressure() const { return tet_pressure_; }

  // --- the multipliers ---

  // Takes the forces at x as the new multipliers; returns the error of the old ones.
  ConstraintError update(const Controls& controls, const std::vector<Vec3>& x,
                         std::span<const double> tet_volume);
  // Multiplies every k by `factor`, until the next start().
  void harden(double factor) {
    hardness_ *= factor;
    contacts_.harden(factor);
  }

  Index contacts() const;  // contacts with a force
  // Stores the multipliers in the state, and the forces of bodies on obstacles.
  void store(State& state) const;
  ContactConstraints& contact_constraints() { return contacts_; }
  const ContactConstraints& contact_constraints() const { return contacts_; }

 private:
  template <typename Spring, typename Cell>
  void spread(const std::vector<Vec3>& x, const Spring& spring, const Cell& cell,
              const TetVolumes& tets, std::vector<Vec3>& force) const;
  double spring_tension(std::size_t k, double length) const;
  double cell_pressure(std::size_t c, double volume) const;

  const Model& model_;
  double hardness_ = 1.0;
  std::vector<double> spring_stiffness_;  // [N/m] (limited)
  std::vector<double> cell_stiffness_;    // [N/m5] (cells; 0: no limit)
  Reactions now_;
  std::vector<SpringTangent> spring_tangent_;
  std::vector<double> cell_tangent_;
  std::vector<double> tet_pressure_;
  ContactConstraints contacts_;
};

// Whether any reaction is not zero.
bool any_active(const Reactions& reactions);

}  // namespace sinew
