// Measurements of a state.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sinew/model/controls.h"
#include "sinew/model/model.h"
#include "sinew/model/state.h"

namespace sinew {

// The nodes of a probe, averaged.
struct ProbeReading {
  std::string name;
  Vec3 position = Vec3::Zero();      // mean of its nodes [m]
  Vec3 displacement = Vec3::Zero();  // of that mean, from its rest position [m]
};
std::vector<ProbeReading> read_probes(const Model& model, const std::vector<Vec3>& x);

// Whether the pin holds nodes of a body; else it moves an anchor or a mesh obstacle.
bool holds_tissue(const Model& model, const Pin& pin);

// What tissue does to a pin that holds it.
struct PinReading {
  std::string name;
  Vec3 center = Vec3::Zero();  // mean of its nodes [m]
  Vec3 force = Vec3::Zero();   // of the body on the pin: elastic and damping forces, contacts, and
                               // the weight of the nodes that it holds [N]
  Vec3 torque = Vec3::Zero();  // about the center [N m]
};
// Of the pins that hold tissue. `force`: of all terms at the state [N] (nodes), contacts excepted.
std::vector<PinReading> read_pins(const Model& model, const Controls& controls, const State& state,
                                  const std::vector<Vec3>& force);

// Forces at places as one force and its torque about a point.
struct ForceSum {
  Vec3 about = Vec3::Zero();
  Vec3 force = Vec3::Zero();
  Vec3 torque = Vec3::Zero();

  void add(const Vec3& place, const Vec3& f) {
    force += f;
    torque += (place - about).cross(f);
  }
};

// The place of the node or edge of a contact force [m].
Vec3 place_of(const ContactForce& c, const std::vector<Vec3>& x);

// Adds the contact forces of the last step to the forces on the nodes [N] (nodes).
void add_contact_forces(const State& state, std::vector<Vec3>& force);

// What a body does to a pin, about a point. `force`: on the nodes, with contacts [N] (nodes).
ForceSum load_on_pin(const Model& model, const Controls& controls, const State& state,
                     const std::vector<Vec3>& force, const Pin& pin, const Vec3& about);

// What the bodies did to a hard obstacle in the last step, about a point.
ForceSum load_on_obstacle(const State& state, Index obstacle, const Vec3& about);

// Tets with v_t < 0 at positions x.
std::int64_t count_inverted(const Model& model, const std::vector<Vec3>& x);

// The volume of all bodies together at positions x over that at rest [-].
double volume_ratio(const Model& model, const std::vector<Vec3>& x);

}  // namespace sinew
