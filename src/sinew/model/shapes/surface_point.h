// The input and output values of the shapes of obstacles. A shape is a struct of plain values in
// its own frame; SolidShape in shape.h lists its members.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "sinew/base/vec.h"

namespace sinew::shapes {

// The surface of a shape near a given point. For a point inside, the normal shows the shortest way
// out; if several are equally short (the centre of a sphere), the choice is fixed.
struct SurfacePoint {
  double distance = 0.0;        // [m] < 0: the point is inside
  Vec3 normal = Vec3::UnitY();  // [-] unit, outwards, of the surface at `nearest`
  Vec3 nearest = Vec3::Zero();  // [m] on the surface
  Vec3 anchor = nearest;  // [m] on the tangent plane at `nearest`: gaps are measured from here
};

// A part of a shape that may slip between the nodes of a surface: all points within `radius` of the
// segment from a to b [m], or a ball if a = b. Of a segment only the part between its ends counts:
// the ends are separate balls.
struct Rod {
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();
  double radius = 0.0;
};

// The sizes of an obstacle in a scene, by key; 0 if a key is missing.
struct Keys {
  double radius = 0.0;       // [m]
  double length = 0.0;       // [m]
  Vec3 size = Vec3::Zero();  // [m]
};

}  // namespace sinew::shapes
