// A motion given by key frames, which a moving pin or obstacle follows.
#pragma once

#include <vector>

#include "sinew/base/vec.h"

namespace sinew {

struct KeyFrame {
  double time = 0.0;               // [s]
  Vec3 move = Vec3::Zero();        // translation since the start [m]
  Vec3 turn = Vec3::Zero();        // rotation vector about the pivot since the start [rad]
  Mat3 deform = Mat3::Identity();  // F: what stretches and shears about the pivot [-]
};

struct Path {
  std::vector<KeyFrame> keys;  // strictly increasing in time; empty: at rest for ever
  Vec3 pivot = Vec3::Zero();   // the point that turn and deform leave where it is [m]
  bool smooth = false;         // between keys: false linear, true smoothstep (velocity 0 at keys)

  // Where the point that rests at X is at time t [m]: x = pivot + R(turn) F (X - pivot) + move,
  // each of the three linear between keys. Before the first key and after the last the motion
  // stands still at that key; a first key later than 0 is approached from rest at time 0.
  Vec3 at(double t, const Vec3& X) const;

  // R(turn) at time t.
  Mat3 rotation(double t) const;

  // Translation, rotation and deformation at time t; its own `time` says nothing.
  KeyFrame frame(double t) const;
};

}  // namespace sinew
