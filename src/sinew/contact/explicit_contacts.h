// What an explicit step does about contacts: finds them (broad and narrow phase, CCD), holds what
// rests (warm start), and answers them (contact solver). docs/methods/contact.md.
#pragma once

#include <vector>

#include "sinew/contact/contact_finder.h"
#include "sinew/contact/contact_solver.h"
#include "sinew/model/model.h"
#include "sinew/model/state.h"
#include "sinew/model/warm_start.h"

namespace sinew {

// Scratch of a run: what step() gives depends on nothing but the Model and the arguments.
class ExplicitContacts {
 public:
  // Keeps a reference to the model.
  explicit ExplicitContacts(const Model& model);

  // Whether anything of the model can touch: where nothing can, no step needs this.
  static bool any(const Model& model);

  // Corrects a step of length h [s] from the positions `before` [m] (nodes). `state` holds the
  // predicted positions and half-step velocities and, in last_step and time, where the step begins;
  // `force` is the force of the step [N] (nodes).
  //
  // Contacts are looked for where the pushes of the step before, state.reactions.contacts, lead the
  // predicted positions: what rests stays where it is, and nothing of it has to be followed on its
  // way. The gaps are those of the predicted positions. If something that pushed is not found
  // there, contacts of its sort are looked for at the predicted positions themselves.
  //
  // Adds work and losses to state.energy; leaves the pushes for the next step in state.reactions,
  // and what bodies push hard obstacles with in state.obstacle_force.
  ContactReport step(const std::vector<Vec3>& before, const std::vector<Vec3>& force, double h,
                     State& state);

  // The contacts that the last step() answered.
  const std::vector<Contact>& contacts() const { return contacts_; }
  ContactFinder& finder() { return finder_; }

 private:
  void find(const std::vector<Vec3>& before, const std::vector<Vec3>& force, double h,
            State& state);
  bool hold(const std::vector<Vec3>& before, const std::vector<Vec3>& force, double h,
            State& state);
  void let_go(State& state);

  const Model& model_;
  ContactFinder finder_;
  ContactScratch scratch_;
  std::vector<Contact> contacts_;  // by id
  std::vector<Contact> surfaces_;  // those between surfaces, by id
  std::vector<NodeHold> holds_;    // of the warm start
  std::vector<Vec3> predicted_;    // where the held nodes were [m] (holds)
  std::vector<Vec3> sum_;          // of warm_start()
};

}  // namespace sinew
