// Values of JSON reports that several programs write.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

#include "sinew/base/vec.h"
#include "sinew/mesh/quality.h"

namespace sinew::report {

// A number; null for NaN and infinity, which JSON does not have.
inline nlohmann::ordered_json finite_or_null(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
}

// [x, y, z]
inline nlohmann::ordered_json to_json(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

inline nlohmann::ordered_json to_json(const Statistics& s) {
  return {{"min", s.min}, {"mean", s.mean}, {"max", s.max}};
}

}  // namespace sinew::report
