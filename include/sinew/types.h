// The plain types of the public interface. SI units: metres, seconds, kilograms, newtons.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace sinew {

using Index = std::int32_t;                // a node, tet ... of a mesh or model, from 0
using Point = std::array<double, 3>;       // x, y, z: a place [m], a direction, a force [N] ...
using Triangle = std::array<Index, 3>;     // three node ids, counter-clockwise seen from outside
using Tet = std::array<Index, 4>;          // four node ids, positive signed volume
using Quaternion = std::array<double, 4>;  // w, x, y, z: a rotation; of any length but 0

// The pose of a rigid object: the point q of its own frame is at center + rotation q.
struct RigidPose {
  Point center = {0.0, 0.0, 0.0};  // [m]
  Quaternion rotation = {1.0, 0.0, 0.0, 0.0};
};

// The motion of a pinned patch since the start: a point that started at X is at
// pivot + R(turn) (X - pivot) + move.
struct RigidMotion {
  Point move = {0.0, 0.0, 0.0};  // translation [m]
  Point turn = {0.0, 0.0, 0.0};  // rotation vector: along the axis, its length the angle [rad]
};

// The force of bodies on a rigid object, and their torque about a stated point.
struct Wrench {
  Point force = {0.0, 0.0, 0.0};   // [N]
  Point torque = {0.0, 0.0, 0.0};  // [N m]
};

// A point of a body that touches an obstacle.
struct ContactPoint {
  Point place = {0.0, 0.0, 0.0};   // of the body [m]
  Point normal = {0.0, 0.0, 0.0};  // unit, out of the obstacle
  double depth = 0.0;              // [m] > 0: inside the obstacle; < 0: distance outside
  Index node = 0;                  // the node at the point; the nearest one if an edge touches
};

// A part of an array: [first, first + count).
struct IndexRange {
  Index first = 0;
  Index count = 0;
};

}  // namespace sinew
