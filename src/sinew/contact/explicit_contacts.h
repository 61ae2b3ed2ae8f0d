// The contacts of an explicit step: the warm start holds resting nodes, the finder (broad phase,
// narrow phase, CCD) finds contacts, the contact solver solves them. docs/methods/contact.md.
#pragma once

#include <vector>

#include "sinew/contact/contact_finder.h"
#include "sinew/contact/contact_solver.h"
#include "sinew/model/controls.h"
#include "sinew/model/model.h"
#include "sinew/model/state.h"
#include "sinew/model/warm_start.h"

namespace sinew {

// Scratch of a run: the result of step() depends on the Model and the arguments only.
class ExplicitContacts {
 public:
  // Keeps a reference to the model.
  explicit ExplicitContacts(const Model& model);

  // Whether anything of the model can touch. The steps of other models need no such object.
  static bool any(const Model& model);

  // Corrects a step of length h [s] from the positions `before` [m] (nodes). `state` holds the
  // predicted positions and half-step velocities, and the start of the step in last_step and time;
  // `force` is the force of the step [N] (nodes).
  //
  // The forces of the step before, state.reactions.contacts, move resting nodes back to their
  // support; contacts are found at those positions, so CCD need not follow a resting node. The gaps
  // are measured at the predicted positions. If a contact of the step before is missing, the
  // contacts of its kind are found again at the predicted positions. If a contact slides far in the
  // step, those at the solved positions that were not found are added, and all are solved again.
  //
  // Adds work and losses to state.energy. Writes the contact forces to state.reactions, from
  // which the next step starts, and the forces of bodies on hard obstacles to state.obstacle_force.
  ContactReport step(const Controls& controls, const std::vector<Vec3>& before,
                     const std::vector<Vec3>& force, double h, State& state);

  // The contacts that the last step() solved.
  const std::vector<Contact>& contacts() const { return contacts_; }
  ContactFinder& finder() { return finder_; }

 private:
  void find(const Controls& controls, const std::vector<Vec3>& before,
            const std::vector<Vec3>& force, double h, State& state);
  bool hold(const std::vector<Vec3>& before, const std::vector<Vec3>& force, double h,
            State& state);
  void let_go(State& state);
  bool slides_far(const std::vector<Vec3>& before, const State& state) const;
  bool add_missed(const Controls& controls, const std::vector<Vec3>& before, double h,
                  const State& solved, const State& predicted);

  const Model& model_;
  ContactFinder finder_;
  ContactScratch scratch_;
  std::vector<Contact> contacts_;  // by id
  std::vector<Contact> surfaces_;  // contacts between surfaces, by id
  std::vector<NodeHold> holds_;    // of the warm start
  std::vector<Vec3> predicted_;    // positions of the held nodes before hold() [m] (holds)
  std::vector<Vec3> sum_;          // scratch of warm_start()
};

}  // namespace sinew
