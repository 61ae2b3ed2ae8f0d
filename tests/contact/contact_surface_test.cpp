#include "sinew/contact/contact_surface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/contact/contact_models.h"

namespace sinew {
namespace {

TEST(ContactSurface, OfTwoCubes) {
  const TetMesh cube = box(Vec3(0.1, 0.1, 0.1), {2, 2, 2});
  const Model model = testing::surface_pair_model({cube, testing::moved(cube, Vec3(1, 0, 0))});
  const ContactSurface& s = model.surface;
  EXPECT_EQ(s.body_count, 2);
  EXPECT_EQ(s.owner_count(), 2);
  EXPECT_EQ(s.triangles.size(), 96u);
  EXPECT_EQ(s.nodes.size(), 52u);
  EXPECT_EQ(s.edges.size(), 144u);  // 3/2 of the triangles: closed
  EXPECT_EQ(s.ring.size(), 3 * s.triangles.size());
  EXPECT_TRUE(std::is_sorted(s.nodes.begin(), s.nodes.end()));
  int sharp = 0;
  for (std::size_t e = 0; e < s.edges.size(); ++e) {
    EXPECT_GE(s.edge_triangles[e][1], 0);
    if (s.edge_bend[e] > 1e-6) {
      ++sharp;
      EXPECT_NEAR(s.edge_bend[e], std::acos(0.0), 1e-12);
    } else {
      EXPECT_NEAR(s.edge_bend[e], 0.0, 1e-7);
    }
  }
  EXPECT_EQ(sharp, 2 * 12 * 2);
  for (const double size : s.triangle_size) {
    EXPECT_GT(size, 0.01);
    EXPECT_LT(size, 0.06);
  }
}

TEST(ContactSurface, NoneWhereNothingTouches) {
  Model model = testing::surface_pair_model({box(Vec3(0.1, 0.1, 0.1), {2, 2, 2})});
  model.body_contact.reset();
  build_contact_surface(model);
  EXPECT_TRUE(model.surface.empty());
  const std::vector<Vec3>& x = model.rest_position;
  EXPECT_TRUE(testing::contacts_of(model, x, x, 1.0).empty());
}

// A rigid mesh: nodes that belong to no body, after those of the bodies.
TEST(ContactSurface, RigidMeshesTouchBodiesAndNotEachOther) {
  const TetMesh cube = box(Vec3(0.1, 0.1, 0.1), {4, 4, 4});
  Model model = testing::surface_pair_model({cube});
  for (int k = 0; k < 2; ++k) {
    const auto first = model.node_count();
    const double y = -0.05 + 0.00001 * k;
    for (const Vec3& p : {Vec3(-1, y, -1), Vec3(-1, y, 1), Vec3(1, y, 1), Vec3(1, y, -1)}) {
      model.rest_position.push_back(p);
      model.inverse_mass.push_back(0.0);
      model.mass.push_back(0.0);
    }
    const std::vector<Triangle> triangles = {{first, first + 1, first + 2},
                                             {first, first + 2, first + 3}};
    add_rigid_contact_surface(model, triangles);
  }
  const std::vector<Contact> found =
      testing::contacts_of(model, model.rest_position, model.rest_position, 0.0001);
  EXPECT_EQ(found.size(), 50u);  // 25 nodes, two plates
  for (const Contact& c : found) {
    EXPECT_LT(c.node[0], model.bodies[0].nodes.end);
    EXPECT_NEAR(c.normal.y(), 1.0, 1e-12);
  }
}

}  // namespace
}  // namespace sinew
