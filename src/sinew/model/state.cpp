#include "sinew/model/state.h"

#include <algorithm>

#include "sinew/base/hash.h"

namespace sinew {

std::uint64_t State::hash() const {
  Hash h;
  h.array(position);
  h.array(half_velocity);
  h.value(last_step);
  h.value(time);
  h.value(step);
  return h.digest();
}

State initial_state(const Model& model) {
  State s;
  s.position = model.rest_position;
  std::copy(model.start_position.begin(), model.start_position.end(), s.position.begin());
  s.half_velocity = model.start_velocity;
  for (const Pin& pin : model.pins) {
    for (const Index node : pin.nodes) {
      const auto n = uz(node);
      s.position[n] = pin.path.at(0.0, model.rest_position[n]);
      s.half_velocity[n] = Vec3::Zero();
    }
  }
  return s;
}

}  // namespace sinew
