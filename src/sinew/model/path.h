// A motion given by key frames; pins and obstacles can follow it.
#pragma once

#include <vector>

#include "sinew/base/vec.h"

namespace sinew {

struct KeyFrame {
  double time = 0.0;               // [s]
  Vec3 move = Vec3::Zero();        // translation since the start [m]
  Vec3 turn = Vec3::Zero();        // rotation vector about the pivot since the start [rad]
  Mat3 deform = Mat3::Identity();  // F: stretch and shear about the pivot [-]
};

struct Path {
  std::vector<KeyFrame> keys;  // strictly increasing in time; empty: always at rest
  Vec3 pivot = Vec3::Zero();   // the fixed point of turn and deform [m]
  bool smooth = false;         // between keys: false linear, true smoothstep (velocity 0 at keys)

  // The position at time t of the point that is at X at rest [m]: x = pivot + R(turn) F (X - pivot)
  // + move, each of the three linear between keys. Before the first key and after the last key the
  // motion stands still at that key; a first key later than 0 is approached from rest at time 0.
  Vec3 at(double t, const Vec3& X) const;

  // R(turn) at time t.
  Mat3 rotation(double t) const;

  // Translation, rotation and deformation at time t; `time` of the result has no meaning.
  KeyFrame frame(double t) const;
};

}  // namespace sinew
