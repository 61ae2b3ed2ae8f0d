// What changes during a run. With the Model's hash it is all that a checkpoint holds.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "sinew/base/vec.h"
#include "sinew/model/contact_id.h"
#include "sinew/model/model.h"

namespace sinew {

// Work and losses summed since the start [J].
struct EnergyAccount {
  double dissipated = 0.0;  // by dashpots, drag, limits, impact and friction
  double work_in = 0.0;     // by moving pins and loads
};

// What a contact pushes with (contact/contact.h says more of what stands here).
struct ContactPush {
  ContactId id;
  std::array<Index, 4> node = {-1, -1, -1, -1};  // those used first
  std::array<double, 4> weight = {};             // of the nodes [-]
  Vec3 push = Vec3::Zero();  // on the place [N]: at the end of an implicit step, mean over Verlet's

  std::size_t count() const {  // nodes used
    return static_cast<std::size_t>(std::find(node.begin(), node.end(), -1) - node.begin());
  }
};
static_assert(sizeof(ContactPush) == sizeof(ContactId) + 4 * sizeof(Index) + 7 * sizeof(double) &&
                  sizeof(ContactId) == 4 * sizeof(Index),
              "no gaps: checkpoints hold its bytes");

// What contacts, the ground's among them, and limits push with at the end of the last step, where
// the next one starts; empty before the first. Verlet's steps know contacts only
// (solver/constraints.h, contact/contact_solver.h).
struct Reactions {
  std::vector<double> tension;   // of each limited spring [N] (as Model::limited), < 0: it pushes
  std::vector<double> pressure;  // on the volume of each limited cell [Pa] (cells), > 0: inwards
  std::vector<ContactPush> contacts;  // those that push, by id
};

struct State {
  std::vector<Vec3> position;  // x(t) [m] (nodes)
  std::vector<Vec3>
      half_velocity;       // w = (x(t) - x(t - h)) / h [m/s] (nodes): Verlet's own velocity
  double last_step = 0.0;  // the h that half_velocity belongs to [s]; 0 before step one
  double time = 0.0;       // [s]
  std::int64_t step = 0;   // steps taken
  EnergyAccount energy;
  Reactions reactions;
  // What bodies push the hard obstacles with, mean over the last step [N] (obstacles).
  std::vector<Vec3> obstacle_force;

  // Positions, velocities, time and step: equal runs have equal hashes at any thread count.
  std::uint64_t hash() const;
};

// Every node at its start position with its start velocity, pins where their paths begin.
State initial_state(const Model& model);

}  // namespace sinew
