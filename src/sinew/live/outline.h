// Triangles for drawing a shape of any kind.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "sinew/model/shapes/shape.h"

namespace sinew::live {

struct Outline {
  std::vector<Vec3> vertices;       // in the shape's own axes [m]
  std::vector<Vec3> normals;        // outwards, of the surface at the vertex (vertices)
  std::vector<Triangle> triangles;  // counter-clockwise seen from outside
};

// The points of a convex, bounded shape that are nearest to a grid of points on a ball around it.
// Many grid points share one nearest point along an edge, with different normals, so edges stay
// sharp.
template <SolidShape S>
Outline outline_of(const S& shape) {
  constexpr Index rings = 24;
  constexpr Index around = 48;
  const double radius = 2.0 * shape.farthest();
  Outline out;
  for (Index i = 0; i <= rings; ++i) {
    const double polar = std::numbers::pi * i / rings;  // from its own z axis
    for (Index k = 0; k < around; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / around;
      const Vec3 direction(std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle),
                           std::cos(polar));
      const shapes::SurfacePoint seen = shape.surface(radius * direction);
      out.vertices.push_back(seen.nearest);
      out.normals.push_back(seen.normal);
    }
  }
  for (Index i = 0; i < rings; ++i) {
    for (Index k = 0; k < around; ++k) {
      const Index a = i * around + k;
      const Index b = i * around + (k + 1) % around;
      out.triangles.push_back({a, a + around, b});
      out.triangles.push_back({b, a + around, b + around});
    }
  }
  return out;
}

}  // namespace sinew::live
