// The data that change during a run. A checkpoint holds them and the Model's hash.
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

// The force of a contact (contact/contact.h describes weights and nodes).
struct ContactForce {
  ContactId id;
  std::array<Index, 4> node = {-1, -1, -1, -1};  // the first count() are used
  std::array<double, 4> weight = {};             // of the nodes [-]
  Vec3 force = Vec3::Zero();  // [N]: at the end of an implicit step, mean over a Verlet step

  std::size_t count() const {  // nodes used
    return static_cast<std::size_t>(std::find(node.begin(), node.end(), -1) - node.begin());
  }
};
static_assert(sizeof(ContactForce) == sizeof(ContactId) + 4 * sizeof(Index) + 7 * sizeof(double) &&
                  sizeof(ContactId) == 4 * sizeof(Index),
              "no gaps: checkpoints hold its bytes");

// The forces of contacts (also with the ground) and of limits at the end of the last step, from
// which the next step starts; empty before the first. Verlet's steps use the contacts only
// (solver/constraints.h, contact/contact_solver.h).
struct Reactions {
  std::vector<double> tension;   // of each limited spring [N] (as Model::limited), < 0: compression
  std::vector<double> pressure;  // of each limited cell [Pa] (cells), > 0: inwards
  std::vector<ContactForce> contacts;  // those with a force, and near ones of implicit steps; by id
};

struct State {
  std::vector<Vec3> position;  // x(t) [m] (nodes)
  std::vector<Vec3>
      half_velocity;       // w = (x(t) - x(t - h)) / h [m/s] (nodes): Verlet's own velocity
  double last_step = 0.0;  // the length of the step of half_velocity [s]; 0 before step one
  double time = 0.0;       // [s]
  std::int64_t step = 0;   // steps taken
  EnergyAccount energy;
  Reactions reactions;
  // The forces of bodies on the hard obstacles, mean over the last step [N] (obstacles).
  std::vector<Vec3> obstacle_force;

  // Positions, velocities, time and step: equal runs have equal hashes at any thread count.
  std::uint64_t hash() const;
};

// Every node at its start position with its start velocity, pins at the start of their paths.
State initial_state(const Model& model);

}  // namespace sinew
