// Contacts of bodies with each other, with themselves and with hard obstacles as part of the
// objective of implicit steps and rest states. docs/methods/contact.md.
#pragma once

#include <memory>
#include <vector>

#include "sinew/contact/contact.h"
#include "sinew/contact/contact_finder.h"
#include "sinew/model/controls.h"
#include "sinew/model/state.h"

namespace sinew {

// A constraint gap >= 0 with friction for every contact found. Within a pass of
// minimise_augmented_lagrangian the nodes, weights and normals of the contacts do not change, so
// the objective is smooth and has a tangent; update() only adds contacts. (If it found all contacts
// again, those of flush bodies and of folds would alternate between faces for ever: two boxes on
// each other took 56 s instead of 8 s for a second.) Contacts keep their force between steps by
// their id, or by the feature if the partner has changed.
class ContactConstraints {
 public:
  // compliance: of the nodes [m/N]; ratio: of a contact's stiffness to the resistance of its nodes;
  // inertia [1/s2]: as in Objective.
  ContactConstraints(const Model& model, const std::vector<double>& compliance, double ratio,
                     double inertia, bool friction);

  bool empty() const { return !finder_; }

  // Takes the contact forces of the state's last step. from: positions at the start of the step [m]
  // (nodes), or null for rest states, which have no friction; the step starts `step` [s] before
  // state.time.
  void start(const Controls& controls, const State& state, const std::vector<Vec3>* from,
             double step);

  double value(const std::vector<Vec3>& x) const;                               // [J]
  void add_forces(const std::vector<Vec3>& x, std::vector<Vec3>& force) const;  // [N]
  void add_reactions(std::vector<Vec3>& force) const;                           // [N]
  void linearise(const std::vector<Vec3>& x);
  void add_stiffness_times(const std::vector<Vec3>& u, std::vector<Vec3>& out) const;

  // A result of linearise(): sum_ab weight_a weight_b block between the contact's nodes.
  struct Tangent {
    const Contact* contact = nullptr;
    Mat3 block = Mat3::Zero();  // [N/m]
  };
  const std::vector<Tangent>& tangents() const { return tangents_; }

  // Takes the forces at x as the multipliers and finds the contacts at x. Returns the change of the
  // forces as a multiple of the tolerance; `friction`: the same for the normal forces that bound
  // friction.
  struct Change {
    double distance = 0.0;
    double friction = 0.0;
    double changed_contacts = 0.0;  // error due to contacts that were found again
  };
  Change update(const Controls& controls, const std::vector<Vec3>& x);
  void harden(double factor) { hardness_ *= factor; }

  // The contacts with a force, and those without that may persist in the next step.
  std::vector<ContactForce> contact_forces(const std::vector<Vec3>& x) const;
  double deepest(const std::vector<Vec3>& x) const;          // [m]
  void add_obstacle_forces(std::vector<Vec3>& force) const;  // of the bodies on obstacles [N]
  // Work of the contact forces on the motion of the obstacles' surfaces, and against the slip [J].
  double work_of_obstacles() const;
  double work_of_friction(const std::vector<Vec3>& x) const;

 private:
  struct Constraint {
    Contact contact;
    double stiffness = 0.0;       // [N/m]
    double friction_bound = 0.0;  // mu times the normal force of the pass before [N]
    Vec3 force = Vec3::Zero();    // multiplier, force of the contact [N]
    Vec3 start = Vec3::Zero();    // contact_offset, also the anchor, at the start of the step [m]
  };
  void find(const Controls& controls, const std::vector<Vec3>& x);
  void add_persisting(const std::vector<Vec3>& x);
  void add_new();
  Constraint constraint_of(const Contact& c) const;
  Vec3 slip(const Constraint& h, const std::vector<Vec3>& x) const;
  Vec3 force_at(const Constraint& h, const std::vector<Vec3>& x) const;

  const Model& model_;
  double ratio_ = 0.0;
  bool friction_ = false;
  double tolerance_ = 0.0;  // [m]
  double reach_ = 0.0;      // [m]
  double hardness_ = 1.0;
  int passes_ = 0;                  // since start()
  double friction_before_ = 0.0;    // Change::friction of the pass before
  std::vector<double> compliance_;  // [m/N] (nodes)
  std::unique_ptr<ContactFinder> finder_;
  const std::vector<Vec3>* from_ = nullptr;
  std::vector<Vec3> here_;           // replaces `from` in rest states [m] (nodes)
  double before_ = 0.0, now_ = 0.0;  // times of the step [s]
  std::vector<Contact> found_;
  std::vector<Constraint> constraints_;  // by id
  std::vector<Tangent> tangents_;
};

}  // namespace sinew
