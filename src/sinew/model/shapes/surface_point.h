// The values that shapes of obstacles give and take. A shape is a struct of plain values in its own
// frame; SolidShape in shape.h lists the members that it has.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "sinew/base/vec.h"

namespace sinew::shapes {

// The surface of a shape as seen from a point. Inside, the normal shows the shortest way out; where
// several are equally short (the centre of a sphere) the choice is fixed.
struct SurfacePoint {
  double distance = 0.0;        // [m] < 0: the point is inside
  Vec3 normal = Vec3::UnitY();  // [-] unit, outwards, of the surface at `nearest`
  Vec3 nearest = Vec3::Zero();  // [m] on the surface
  Vec3 anchor = nearest;        // [m] on its tangent plane there, from where gaps are measured
};

// A part of a shape that may slip between the nodes of a surface: what is within `radius` of the
// segment from a to b [m], or a ball where both ends are one. Of a segment only what lies between
// its ends counts: its ends are balls of their own.
struct Rod {
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();
  double radius = 0.0;
};

// The sizes that a scene gives for an obstacle, by key; 0 where it gives none.
struct Keys {
  double radius = 0.0;       // [m]
  double length = 0.0;       // [m]
  Vec3 size = Vec3::Zero();  // [m]
};

}  // namespace sinew::shapes
