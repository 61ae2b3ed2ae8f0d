// Paths that a host changes during a run, and their rotations.
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

// The rotation vector of a rotation [rad]. Of the vectors that differ by whole turns, the one
// nearest to `near`.
Vec3 rotation_vector(const Mat3& rotation, const Vec3& near);

// Gives the path of a mesh obstacle to the pin of its nodes, too. Call after the path has changed.
void let_pin_follow(Controls& controls, const Model& model, std::size_t obstacle);

// Replaces the keys of the path. The old motion is kept up to `start` [s], as far back as the last
// step of length `last_step` [s] needs it; then the path leads to `to`, a motion about `pivot`, at
// constant speed until `end` > start, and stays there.
void lead_path(Path& path, const Vec3& pivot, const KeyFrame& to, double last_step, double start,
               double end);

}  // namespace sinew::sim
