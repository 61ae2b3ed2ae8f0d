#include "sinew/contact/planes.h"

#include <gtest/gtest.h>

#include "sinew/forces/assemble.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

// Two masses, of which the second is held; a plane that rises by 1 m/s, and what is no hard plane.
Model two_masses() {
  Model model = test::point_masses({{Vec3(1, -0.3, 2), 1.0}, {Vec3(1, -0.3, 3), 0.0}});
  Obstacle rising = make_ground(Vec3::Zero(), Vec3::UnitY(), 0.0, 0.5);
  rising.path.keys = {{0.0}, {1.0, Vec3(0, 1, 0)}};
  Obstacle ball;
  ball.shape = shapes::Sphere{9.0};
  model.obstacles = {ball, rising};
  finish(model);
  return model;
}

TEST(Planes, AreHalfSpacesAsTheyAreAtATime) {
  const Model model = two_masses();
  for (const double time : {0.0, 0.25}) {
    int count = 0;
    for_each_hard_plane(model, initial_controls(model), time, [&](const HalfSpace& plane) {
      ++count;
      EXPECT_EQ(plane.point, Vec3(0, time, 0));
      EXPECT_EQ(plane.normal, Vec3::UnitY());
      EXPECT_EQ(plane.height(Vec3(5, 1, 5)), 1.0 - time);
    });
    EXPECT_EQ(count, 1);
  }
}

TEST(Planes, LiftFreeNodesThatAreBelow) {
  const Model model = two_masses();
  std::vector<Vec3> x = model.rest_position;
  EXPECT_EQ(lift_onto_planes(model, initial_controls(model), 0.5, x), 1);
  EXPECT_EQ(x[0], Vec3(1, 0.5, 2));
  EXPECT_EQ(x[1], Vec3(1, -0.3, 3));
  EXPECT_EQ(lift_onto_planes(model, initial_controls(model), 0.5, x), 0);
}

}  // namespace
}  // namespace sinew
