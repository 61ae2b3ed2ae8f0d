#include "sinew/contact/colliders.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sinew/base/parallel.h"
#include "sinew/base/random.h"
#include "sinew/contact/contact_finder.h"
#include "sinew/contact/contact_surface.h"
#include "sinew/forces/obstacles.h"
#include "tests/support/models.h"

namespace sinew {
namespace {

Obstacle hard(const Shape& shape, const Vec3& center) {
  Obstacle o;
  o.name = "o";
  o.shape = shape;
  o.center = center;
  return o;
}

Obstacle hard_sphere(const Vec3& center, double radius) {
  return hard(shapes::Sphere{radius}, center);
}

// A box of tissue, 0.1 m wide, of cells of 25 mm, about the origin; and what it touches.
struct Scenery {
  explicit Scenery(const std::vector<Obstacle>& obstacles)
      : model(test::tissue_box(Material{}, {4, 4, 4})) {
    for (const Obstacle& o : obstacles) model.obstacles.push_back(o);
    build_skin(model);
    finish(model);
    from = to = model.rest_position;
  }
  std::vector<Contact> find(double reach = 0.0, double t1 = 0.0) {
    std::vector<Contact> out;
    find_collider_contacts(model, initial_controls(model), from, to, 0.0, t1, reach, out);
    return out;
  }
  // Of the first obstacle.
  Pose pose(double time) const { return obstacle_pose(model, initial_controls(model), 0, time); }
  void move(const Vec3& before, const Vec3& after) {
    for (std::size_t i = 0; i < from.size(); ++i) {
      from[i] = model.rest_position[i] + before;
      to[i] = model.rest_position[i] + after;
    }
  }
  Model model;
  std::vector<Vec3> from, to;
};

Index count_of(const std::vector<Contact>& contacts, int nodes) {
  Index n = 0;
  for (const Contact& c : contacts) n += c.count == nodes ? 1 : 0;
  return n;
}

TEST(Colliders, ABoxOnAPlaneTouchesWithTheNodesOfOneSide) {
  Obstacle plane = hard(shapes::Plane{}, Vec3(0, -0.05, 0));
  plane.friction = 0.3;
  plane.restitution = 0.7;
  Scenery s({plane});
  s.move(Vec3(0, 0.001, 0), Vec3(0, -0.001, 0));
  const auto contacts = s.find();
  ASSERT_EQ(contacts.size(), 25U);
  for (const Contact& c : contacts) {
    EXPECT_EQ(c.count, 1);
    EXPECT_EQ(c.weight[0], 1.0);
    EXPECT_EQ(c.normal, Vec3::UnitY());
    EXPECT_NEAR(c.gap, -0.001, 1e-15);
    EXPECT_NEAR(c.time_of_impact, 0.5, 1e-12);
    EXPECT_EQ(c.anchor_displacement, Vec3::Zero());
    EXPECT_EQ(c.friction, 0.3);
    EXPECT_EQ(c.restitution, 0.7);
    EXPECT_EQ(c.id.obstacle(), 0);
    EXPECT_EQ(c.gap, contact_gap(c, s.to));
  }
  s.move(Vec3(0, 0.001, 0), Vec3(0, 0.001, 0));
  EXPECT_TRUE(s.find().empty());
  EXPECT_EQ(s.find(0.002).size(), 25U);
  EXPECT_EQ(s.find(0.002)[0].time_of_impact, 1.0);
}

TEST(Colliders, WhatIsFarGivesNothing) {
  Obstacle box = hard(shapes::Box{Vec3(0.1, 0.1, 0.1)}, Vec3(0, 1, 0));
  Scenery s({hard(shapes::Plane{}, Vec3(0, -1, 0)), hard_sphere(Vec3(1, 0, 0), 0.1), box});
  EXPECT_TRUE(s.find(0.01).empty());
}

TEST(Colliders, PinnedNodesDoNotTouch) {
  Scenery s({hard(shapes::Plane{}, Vec3(0, 1, 0))});
  EXPECT_FALSE(s.find().empty());
  std::fill(s.model.inverse_mass.begin(), s.model.inverse_mass.end(), 0.0);
  EXPECT_TRUE(s.find().empty());
}

TEST(Colliders, AMovingTurningPlaneCarriesItsPoints) {
  Obstacle plane = hard(shapes::Plane{}, Vec3(0, -0.06, 0));
  plane.path.keys = {{0.0}, {1.0, Vec3(0, 0.02, 0), Vec3(0, 0, 0.1)}};
  plane.path.pivot = plane.center;
  Scenery s({plane});
  const auto contacts = s.find(0.0, 1.0);
  ASSERT_FALSE(contacts.empty());
  const Pose before = s.pose(0.0);
  const Pose after = s.pose(1.0);
  for (const Contact& c : contacts) {
    EXPECT_LT((c.normal - Vec3(-std::sin(0.1), std::cos(0.1), 0)).norm(), 1e-12);
    const Vec3 place = s.to[uz(c.node[0])] - c.gap * c.normal;  // on the plane
    EXPECT_LT((place - c.anchor_displacement - before.at(after.own(place))).norm(), 1e-15);
    EXPECT_LT(c.gap, 0.0);
    EXPECT_GT(c.time_of_impact, 0.0);
    EXPECT_LT(c.time_of_impact, 1.0);
  }
}

// A thin sheet that a fast node crosses within a step: it is led back to where it came from.
TEST(Colliders, AThinBoxIsNotTunnelledThrough) {
  Obstacle sheet = hard(shapes::Box{Vec3(1, 0.0005, 1)}, Vec3(0, -0.2, 0));
  Scenery s({sheet});
  s.move(Vec3::Zero(), Vec3(0.01, -1, 0));
  const auto contacts = s.find();
  EXPECT_EQ(count_of(contacts, 1), 98);  // every node of the surface went through
  for (const Contact& c : contacts) {
    if (c.count != 1) continue;
    EXPECT_EQ(c.normal, Vec3::UnitY());
    EXPECT_LT(c.gap, 0.0);
    EXPECT_GT(c.time_of_impact, 0.0);
    EXPECT_LT(c.time_of_impact, 1.0);
  }
  // Deeper than its middle, but not through.
  s.move(Vec3(0, -0.1494, 0), Vec3(0, -0.1503, 0));
  for (const Contact& c : s.find()) EXPECT_EQ(c.normal, Vec3::UnitY());
  EXPECT_EQ(count_of(s.find(), 1), 25);
}

TEST(Colliders, AFastObstacleIsSeenTheSame) {
  Obstacle ball = hard_sphere(Vec3(0.001, 0.3, 0.002), 0.06);
  ball.path.keys = {{0.0}, {0.01, Vec3(0, -1, 0)}};
  Scenery moving({ball});
  Scenery still({hard_sphere(ball.center, 0.06)});
  still.move(Vec3::Zero(), Vec3(0, 1, 0));
  const auto a = moving.find(0.0, 0.01);
  const auto b = still.find();
  ASSERT_GT(b.size(), 5U);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].id, b[i].id);
    EXPECT_NEAR(a[i].gap, b[i].gap, 1e-12);
    EXPECT_LT((a[i].normal - b[i].normal).norm(), 1e-9);
    EXPECT_LT((a[i].anchor_displacement - Vec3(0, -1, 0)).norm(), 1e-12);
  }
}

// One of every solid shape, a few centimetres large.
std::vector<Shape> small_solids() {
  std::vector<Shape> out;
  for_each_shape([&](const auto& shape) {
    if constexpr (SolidShape<std::decay_t<decltype(shape)>>)
      out.push_back(shape.from({0.04, 0.12, Vec3(0.1, 0.04, 0.12)}));
  });
  return out;
}

// Nothing is missed and nothing is too much: every node by the signed distance, in random places.
TEST(Colliders, NodesAsByBruteForce) {
  std::uint64_t seed = 77;
  for (int round = 0; round < 10; ++round) {
    for (const Shape& shape : small_solids()) {
      Obstacle o = hard(shape, 0.12 * (2.0 * random_point(seed++) - Vec3::Ones()));
      const double angle = 3.0 * random_number(seed++);
      const Vec3 axis = random_point(seed++).normalized();
      o.rotation = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
      Scenery s({o});
      const Vec3 step = 0.002 * (2.0 * random_point(seed++) - Vec3::Ones());
      s.move(Vec3::Zero(), step);
      const double reach = 0.003;
      Index expected = 0;
      double depth = 0.0;
      const Pose pose = s.pose(0.0);
      for (const Index n : s.model.skin.nodes) {
        const double d = std::visit(
            Overloaded{
                [](const shapes::Mesh&) { return no_limit; },
                [&](const auto& solid) { return solid.surface(pose.own(s.to[uz(n)])).distance; }},
            shape);
        expected += d < reach ? 1 : 0;
        depth = std::max(depth, -d);
      }
      const std::vector<Contact> contacts = s.find(reach);
      EXPECT_EQ(count_of(contacts, 1), expected) << word_of(shape) << ", round " << round;
      for (const Contact& c : contacts) {
        EXPECT_NEAR(c.gap, contact_gap(c, s.to), 1e-16);
        if (c.count == 1) {
          EXPECT_GE(c.gap, -depth - 1e-3);
        }
      }
    }
  }
}

// A needle between four nodes of the top: no node is near, the triangle or its edge is.
TEST(Colliders, ANeedleDoesNotSlipBetweenNodes) {
  std::uint64_t seed = 5;
  for (int round = 0; round < 50; ++round) {
    const double radius = 0.001;
    Obstacle needle = hard(shapes::Capsule{radius, 0.05}, Vec3::Zero());
    // Its axis along y, its tip at a random place 1 mm above the top at y = 0.05.
    needle.rotation = Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX()).toRotationMatrix();
    const Vec3 place = random_point(seed++);
    const double fast = round % 2 == 0 ? 0.0015 : 0.08;  // [m] in the step
    needle.center =
        Vec3(0.08 * place.x() - 0.04, 0.05 + 0.05 + 2 * radius, 0.08 * place.z() - 0.04);
    needle.path.keys = {{0.0}, {1.0, Vec3(0, -fast, 0)}};
    Scenery s({needle});
    const auto contacts = s.find(0.0, 1.0);
    ASSERT_FALSE(contacts.empty()) << "round " << round;
    double deepest = 0.0;
    for (const Contact& c : contacts) {
      EXPECT_EQ(c.node[0] >= 0 && c.count >= 1 && c.count <= 3, true);
      double sum = 0.0;
      for (int a = 0; a < c.count; ++a) sum += c.weight[static_cast<std::size_t>(a)];
      EXPECT_NEAR(sum, 1.0, 1e-12);
      EXPECT_NEAR(c.gap, contact_gap(c, s.to), 1e-15);
      EXPECT_LT(c.normal.y(), 0.1) << "round " << round;  // out of the needle: into the body
      deepest = std::min(deepest, c.gap);
    }
    EXPECT_NEAR(deepest, -(fast - radius), 2e-4) << "round " << round;
  }
}

// The corner of a box, pressed between nodes of a flat side.
TEST(Colliders, TheCornerOfABoxDoesNotSlipBetweenNodes) {
  Obstacle box = hard(shapes::Box{Vec3(0.02, 0.02, 0.02)}, Vec3::Zero());
  // A diagonal upright.
  box.rotation =
      Eigen::Quaterniond::FromTwoVectors(Vec3(1, 1, 1), Vec3(0, 1, 0)).toRotationMatrix();
  box.center = Vec3(0.008, 0.05 + 0.02 * std::sqrt(3.0) + 0.0005, 0.009);
  box.path.keys = {{0.0}, {1.0, Vec3(0, -0.006, 0)}};
  Scenery s({box});
  const auto contacts = s.find(0.0, 1.0);
  ASSERT_FALSE(contacts.empty());
  // Rounded: the corner stands back by (sqrt(3) - 1) times the rounding of 4 mm.
  const double depth = 0.0055 - (std::sqrt(3.0) - 1.0) * 0.004;
  const Contact& deepest =
      *std::min_element(contacts.begin(), contacts.end(),
                        [](const Contact& a, const Contact& b) { return a.gap < b.gap; });
  EXPECT_NEAR(deepest.gap, -depth, 1e-9);
  EXPECT_LT((deepest.normal + Vec3::UnitY()).norm(), 1e-9);
  for (const Contact& c : contacts) EXPECT_LT(c.normal.y(), -0.5);
}

// A thin rod lying across an edge of the body: edge against rod, no node and no triangle.
TEST(Colliders, ARodAcrossAnEdgeTouchesTheEdge) {
  Obstacle rod = hard(shapes::Capsule{0.002, 0.05}, Vec3::Zero());
  rod.rotation =
      Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), Vec3(1, -1, 0)).toRotationMatrix();
  const Vec3 out = Vec3(1, 1, 0).normalized();
  rod.center = Vec3(0.05, 0.05, 0.011) + 0.0015 * out;
  Scenery s({rod});
  const auto contacts = s.find();
  ASSERT_EQ(contacts.size(), 1U);
  EXPECT_EQ(contacts[0].count, 2);
  EXPECT_NEAR(contacts[0].gap, -0.0005, 1e-12);
  EXPECT_LT((contacts[0].normal + out).norm(), 1e-9);
}

TEST(Colliders, LargeSpheresTouchWithNodesOnly) {
  Scenery s({hard_sphere(Vec3(0.01, 0.145, 0), 0.1)});
  EXPECT_EQ(count_of(s.find(), 1), static_cast<Index>(s.find().size()));
  Scenery small({hard_sphere(Vec3(0.01, 0.065, 0.004), 0.016)});
  EXPECT_GT(count_of(small.find(), 3) + count_of(small.find(), 2), 0);
}

TEST(Colliders, KeysAreSortedAndDifferent) {
  Obstacle box = hard(shapes::Box{Vec3(0.05, 0.05, 0.05)}, Vec3(0.03, 0.03, 0.03));
  Scenery s({hard_sphere(Vec3(0.01, 0.065, 0.004), 0.03), box, hard_sphere(Vec3(0, 0, 0), 0.06)});
  const auto contacts = s.find(0.01);
  ASSERT_GT(contacts.size(), 50U);
  for (std::size_t i = 1; i < contacts.size(); ++i) EXPECT_LT(contacts[i - 1].id, contacts[i].id);
}

TEST(Colliders, DegenerateTrianglesGiveNumbers) {
  Obstacle box = hard(shapes::Box{Vec3(0.05, 0.05, 0.05)}, Vec3(0, 0.05, 0));
  Scenery s({box, hard_sphere(Vec3(0, 0.02, 0), 0.02)});
  for (Vec3& x : s.to) x = Vec3(0, 0.02, 0);
  for (const Contact& c : s.find(0.01)) {
    EXPECT_TRUE(std::isfinite(c.gap));
    EXPECT_TRUE(c.normal.allFinite());
  }
  s.from = s.to;
  for (const Contact& c : s.find(0.01)) EXPECT_TRUE(std::isfinite(c.gap) && c.normal.allFinite());
}

// A sheet of two triangles under the box: what touches a mesh is told as with any other collider.
TEST(Colliders, ContactsWithAMeshHaveAnAnchorAndNoRigidNodes) {
  Model model = test::tissue_box(Material{}, {4, 4, 4});
  Obstacle o;
  o.name = "sheet";
  o.friction = 0.2;
  o.restitution = 0.4;
  o.path.keys = {{0.0}, {1.0, Vec3(0, 0.002, 0)}};
  const std::vector<Vec3> corners = {Vec3(-1, -0.051, -1), Vec3(1, -0.051, -1), Vec3(1, -0.051, 1),
                                     Vec3(-1, -0.051, 1)};
  const std::vector<Triangle> triangles = {{0, 2, 1}, {0, 3, 2}};
  add_mesh_obstacle(model, o, corners, triangles);
  build_contact_surface(model);
  finish(model);
  EXPECT_EQ(model.node_name(model.body_node_count() + 2), "obstacle sheet, vertex 2");
  const std::vector<Vec3> from = model.rest_position;
  std::vector<Vec3> to = from;
  for (auto i = uz(model.body_node_count()); i < to.size(); ++i) to[i].y() += 0.002;
  std::vector<Contact> contacts;
  ContactFinder finder(model);
  finder.find(initial_controls(model), from, to, 0.0, 1.0, 0.0, contacts);
  EXPECT_EQ(count_of(contacts, 1), 25);
  for (const Contact& c : contacts) {
    EXPECT_EQ(c.id.obstacle(), 0);
    EXPECT_EQ(c.friction, 0.2);
    EXPECT_EQ(c.restitution, 0.4);
    EXPECT_LT((c.normal - Vec3::UnitY()).norm(), 1e-12);
    EXPECT_LT((c.anchor_displacement - Vec3(0, 0.002, 0)).norm(), 1e-12);
    EXPECT_NEAR(c.gap, -0.001, 1e-12);
    EXPECT_NEAR(contact_gap(c, to), c.gap, 1e-12);
    for (int a = 0; a < c.count; ++a)
      EXPECT_LT(c.node[static_cast<std::size_t>(a)], model.body_node_count());
  }
}

// The tip of a rigid pyramid between the nodes of a side.
TEST(Colliders, AVertexOfAMeshPushesATriangle) {
  Model model = test::tissue_box(Material{}, {4, 4, 4});
  Obstacle o;
  o.name = "tip";
  o.path.keys = {{0.0}, {1.0, Vec3(0, -0.003, 0)}};
  const std::vector<Vec3> corners = {Vec3(0.008, 0.051, 0.004), Vec3(0.03, 0.08, -0.02),
                                     Vec3(-0.02, 0.08, -0.02), Vec3(0.008, 0.08, 0.03)};
  const std::vector<Triangle> triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  add_mesh_obstacle(model, o, corners, triangles);
  build_contact_surface(model);
  finish(model);
  const std::vector<Vec3> from = model.rest_position;
  std::vector<Vec3> to = from;
  for (auto i = uz(model.body_node_count()); i < to.size(); ++i) to[i].y() -= 0.003;
  std::vector<Contact> contacts;
  ContactFinder finder(model);
  finder.find(initial_controls(model), from, to, 0.0, 1.0, 0.0, contacts);
  ASSERT_EQ(contacts.size(), 1U);
  const Contact& c = contacts[0];
  EXPECT_EQ(c.count, 3);
  EXPECT_NEAR(c.weight[0] + c.weight[1] + c.weight[2], 1.0, 1e-12);
  EXPECT_LT((c.normal + Vec3::UnitY()).norm(), 1e-12);
  EXPECT_LT((c.anchor - Vec3(0.008, 0.048, 0.004)).norm(), 1e-12);
  EXPECT_NEAR(c.gap, -0.002, 1e-12);
}

}  // namespace
}  // namespace sinew
