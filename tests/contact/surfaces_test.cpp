#include "sinew/contact/surfaces.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/contact/touch_models.h"

namespace sinew {
namespace {

using testing::contacts_of;
using testing::moved;
using testing::random_rotation;
using testing::touching_model;

TEST(SurfaceContacts, TwoCubesThatLieOnEachOther) {
  const TetMesh cube = box(Vec3(0.1, 0.1, 0.1), {4, 4, 4});
  const Model model = touching_model({cube, moved(cube, Vec3(0.011, 0.1, 0.013))});
  std::vector<Vec3> to = model.rest_position;
  for (Index i = model.bodies[1].nodes.begin; i < model.bodies[1].nodes.end; ++i) {
    to[uz(i)].y() -= 1e-4;
  }
  const std::vector<Contact> found = contacts_of(model, model.rest_position, to);
  // 4 x 4 nodes of either overlap the other's face; edges meet where the rims cross only.
  std::size_t nodes = 0;
  for (const Contact& c : found) nodes += c.weight[0] == 1.0;
  EXPECT_EQ(nodes, 32u);
  EXPECT_LE(found.size(), 36u);
  for (const Contact& c : found) {
    EXPECT_NEAR(c.gap, -1e-4, 1e-12);
    EXPECT_NEAR(std::abs(c.normal.y()), 1.0, 1e-12);
    EXPECT_EQ(c.normal.y() > 0.0, model.bodies[1].nodes.contains(c.node[0]));
    EXPECT_NEAR(c.weight[0] + c.weight[1] + c.weight[2] + c.weight[3], 0.0, 1e-15);
    EXPECT_NEAR(c.moment, 0.0, 1e-9);
  }
}

TEST(SurfaceContacts, NothingTouchesAtRestOrMovedRigidlyOrStretched) {
  std::mt19937 rng(7);
  std::uniform_real_distribution<double> stretch(0.6, 1.6);
  const std::vector<TetMesh> meshes = {box(Vec3(0.1, 0.1, 0.1), {4, 4, 4}),
                                       box(Vec3(0.2, 0.2, 0.002), {10, 10, 1}),
                                       beam(Vec3(0.02, 0.02, 0.2), {2, 2, 20}, 0.3),
                                       sphere(0.05, 4),
                                       hollow_sphere(0.05, 0.045, 1),
                                       cylinder(0.05, 0.01, 4),
                                       ellipsoid(Vec3(0.1, 0.03, 0.01), 4),
                                       box(Vec3(0.3, 0.3, 0.003), {3, 3, 1})};
  for (const TetMesh& mesh : meshes) {
    const Model model = touching_model({mesh});
    SurfaceContacts contacts(model);
    std::vector<Contact> found;
    const auto& rest = model.rest_position;
    for (const double reach : {0.0, 1e-4, 0.01}) {
      contacts.find(rest, rest, reach, found);
      EXPECT_TRUE(found.empty()) << found.size();
      for (int n = 0; n < 20; ++n) {
        const Mat3 q = random_rotation(rng);
        const Mat3 f =
            q * Vec3(stretch(rng), stretch(rng), stretch(rng)).asDiagonal() * random_rotation(rng);
        std::vector<Vec3> x = rest, turned = rest;
        for (std::size_t i = 0; i < rest.size(); ++i) {
          x[i] = f * rest[i] + Vec3(n, 0, 0);
          turned[i] = q * rest[i];
        }
        contacts.find(x, x, reach, found);
        EXPECT_TRUE(found.empty()) << found.size();
        contacts.find(turned, turned, reach, found);
        EXPECT_TRUE(found.empty()) << found.size();
      }
    }
  }
}

TEST(SurfaceContacts, AFastBallDoesNotTunnelThroughAMembrane) {
  const TetMesh membrane = box(Vec3(0.2, 0.001, 0.2), {20, 1, 20});
  const TetMesh ball = moved(sphere(0.02, 3), Vec3(0.0031, 0.05, 0.0042));
  const Model model = touching_model({membrane, ball});
  for (const double way : {0.01, 0.031, 0.05, 0.1, 0.8}) {
    std::vector<Vec3> to = model.rest_position;
    Index through = 0;
    for (Index i = model.bodies[1].nodes.begin; i < model.bodies[1].nodes.end; ++i) {
      to[uz(i)].y() -= way;
    }
    const std::vector<Contact> found = contacts_of(model, model.rest_position, to);
    for (const Contact& c : found) through += model.bodies[1].nodes.contains(c.node[0]);
    Index expected = 0;
    for (const Index i : model.surface.nodes) {
      if (model.bodies[1].nodes.contains(i)) expected += to[uz(i)].y() < 0.0005;
    }
    EXPECT_EQ(through, expected) << way;
    for (const Contact& c : found) {
      if (!model.bodies[1].nodes.contains(c.node[0]) || c.count != 4) continue;
      EXPECT_GT(c.normal.y(), 0.9);
      EXPECT_NEAR(c.gap, to[uz(c.node[0])].y() - 0.0005, 1e-9);
    }
  }
}

}  // namespace
}  // namespace sinew
