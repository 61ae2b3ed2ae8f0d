// Measurements of a state.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sinew/model/model.h"

namespace sinew {

// The nodes of a probe, averaged.
struct ProbeReading {
  std::string name;
  Vec3 position = Vec3::Zero();      // mean of its nodes [m]
  Vec3 displacement = Vec3::Zero();  // of that mean, from its rest position [m]
};
std::vector<ProbeReading> read_probes(const Model& model, const std::vector<Vec3>& x);

// Tets with v_t < 0 at positions x.
std::int64_t count_inverted(const Model& model, const std::vector<Vec3>& x);

// The volume of all bodies together at positions x over that at rest [-].
double volume_ratio(const Model& model, const std::vector<Vec3>& x);

}  // namespace sinew
