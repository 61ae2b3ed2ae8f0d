// Paths that a host writes while a run goes on, and the rotations in them.
#pragma once

#include <sinew/types.h>

#include "sinew/base/vec.h"
#include "sinew/model/controls.h"
#include "sinew/model/model.h"

namespace sinew::sim {

inline Vec3 vec(const Point& p) {
  return {p[0], p[1], p[2]};
}
inline Point point(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

// The rotation vector of a rotation [rad]; of those that differ by whole turns, the one nearest to
// `near`.
Vec3 rotation_vector(const Mat3& rotation, const Vec3& near);

// Gives the obstacle's path to the pin of its nodes as well, where it is a mesh. Call after the
// path has changed.
void let_pin_follow(Controls& controls, const Model& model, std::size_t obstacle);

// Writes the path anew: up to `start` [s] as it was, as far back as a step of `last_step` [s]
// looks; then to `to`, which is a motion about `pivot`, at constant speed until `end` > start; then
// still.
void lead_path(Path& path, const Vec3& pivot, const KeyFrame& to, double last_step, double start,
               double end);

}  // namespace sinew::sim
