#include "sinew/live/outline.h"

#include <gtest/gtest.h>

#include "sinew/model/shapes/shape.h"

namespace sinew::live {
namespace {

// The volume inside a closed surface: the sum of the tets to the origin.
double volume_of(const Outline& outline) {
  double volume = 0.0;
  for (const Triangle& t : outline.triangles) {
    const Vec3& a = outline.vertices[uz(t[0])];
    volume += a.dot(outline.vertices[uz(t[1])].cross(outline.vertices[uz(t[2])])) / 6.0;
  }
  return volume;
}

TEST(Outline, IsTheSurfaceSeenFromOutside) {
  const shapes::Box box{Vec3(0.1, 0.2, 0.3)};
  const Outline outline = outline_of(box);
  ASSERT_EQ(outline.normals.size(), outline.vertices.size());
  for (std::size_t i = 0; i < outline.vertices.size(); ++i) {
    EXPECT_LT((outline.vertices[i].cwiseAbs() - Vec3(0.1, 0.2, 0.3)).maxCoeff(), 1e-12);
    EXPECT_NEAR(outline.normals[i].norm(), 1.0, 1e-9);
    EXPECT_GT(outline.normals[i].dot(outline.vertices[i]), 0.0);
  }
  EXPECT_NEAR(volume_of(outline), 8.0 * 0.1 * 0.2 * 0.3, 0.1 * 8.0 * 0.1 * 0.2 * 0.3);
}

}  // namespace
}  // namespace sinew::live
