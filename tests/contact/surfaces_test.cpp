#include "sinew/contact/surfaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sinew/mesh/tet_mesh.h"
#include "tests/contact/contact_models.h"

namespace sinew {
namespace {

using testing::contacts_of;
using testing::moved;
using testing::random_rotation;
using testing::surface_pair_model;

#ifdef SINEW_SANITIZED
constexpr bool sanitized = true;  // geometry takes ten times as long
#else
constexpr bool sanitized = false;
#endif

TEST(SurfaceContacts, TwoCubesThatLieOnEachOther) {
  const TetMesh cube = box(Vec3(0.1, 0.1, 0.1), {4, 4, 4});
  const Model model = surface_pair_model({cube, moved(cube, Vec3(0.011, 0.1, 0.013))});
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
    EXPECT_NEAR(c.time_of_impact, 0.0, 1e-9);
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
    const Model model = surface_pair_model({mesh});
    SurfaceContacts contacts(model);
    std::vector<Contact> found;
    const auto& rest = model.rest_position;
    for (const double reach : {0.0, 1e-4, 0.01}) {
      contacts.find(rest, rest, reach, found);
      EXPECT_TRUE(found.empty()) << found.size();
      for (int n = 0; n < (sanitized ? 1 : 10); ++n) {
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
  const Model model = surface_pair_model({membrane, ball});
  for (const double displacement : {0.01, 0.031, 0.05, 0.1, 0.8}) {
    std::vector<Vec3> to = model.rest_position;
    Index through = 0;
    for (Index i = model.bodies[1].nodes.begin; i < model.bodies[1].nodes.end; ++i) {
      to[uz(i)].y() -= displacement;
    }
    const std::vector<Contact> found = contacts_of(model, model.rest_position, to);
    for (const Contact& c : found) through += model.bodies[1].nodes.contains(c.node[0]);
    Index expected = 0;
    for (const Index i : model.surface.nodes) {
      if (model.bodies[1].nodes.contains(i)) expected += to[uz(i)].y() < 0.0005;
    }
    EXPECT_EQ(through, expected) << displacement;
    for (const Contact& c : found) {
      if (!model.bodies[1].nodes.contains(c.node[0]) || c.count != 4) continue;
      EXPECT_GT(c.normal.y(), 0.9);
      EXPECT_NEAR(c.gap, to[uz(c.node[0])].y() - 0.0005, 1e-9);
    }
  }
}

// Tiny tets, all over a cube of the given half side, but not where `keep` says no.
template <typename Keep>
TetMesh cloud(int count, double half, double size, std::mt19937& rng, const Keep& keep) {
  std::uniform_real_distribution<double> u(-half, half);
  TetMesh mesh;
  while (mesh.tet_count() < count) {
    const Vec3 p(u(rng), u(rng), u(rng));
    if (!keep(p)) continue;
    const Index first = mesh.node_count();
    for (const Vec3& d : {Vec3(0, 0, 0), Vec3(size, 0, 0), Vec3(0, size, 0), Vec3(0, 0, size)}) {
      mesh.nodes.push_back(p + d);
    }
    mesh.tets.push_back({first, first + 1, first + 2, first + 3});
  }
  return mesh;
}

TEST(SurfaceContacts, NothingGetsIntoAClosedSurfaceUnseen) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  const std::vector<TetMesh> targets = {sphere(0.05, 3), box(Vec3(0.08, 0.08, 0.08), {2, 2, 2}),
                                        hollow_sphere(0.05, 0.045, 1)};
  for (const TetMesh& target : targets) {
    const TetMesh grains = cloud(sanitized ? 60 : 400, 0.15, 1e-4, rng,
                                 [](const Vec3& p) { return p.cwiseAbs().maxCoeff() > 0.055; });
    const Model model = surface_pair_model({target, grains}, {true, false, 0.5, 0.0});
    Index all_inside = 0;
    for (const double speed : {0.0005, 0.01, 0.05, 0.1, 0.3}) {
      std::vector<Vec3> to = model.rest_position;
      const Mat3 turn = random_rotation(rng, 0.3);
      for (Index i = 0; i < model.bodies[0].nodes.end; ++i) to[uz(i)] = 1.1 * (turn * to[uz(i)]);
      for (Index t = model.bodies[1].tets.begin; t < model.bodies[1].tets.end; ++t) {
        // Half of it towards the target.
        const Vec3 inwards = -model.rest_position[uz(model.tets[uz(t)][0])].normalized();
        const Vec3 displacement = speed * (Vec3(u(rng), u(rng), u(rng)) + inwards);
        for (const Index i : model.tets[uz(t)]) to[uz(i)] += displacement;
      }
      std::vector<char> in_contact(to.size(), 0);
      for (const Contact& c : contacts_of(model, model.rest_position, to)) {
        if (c.weight[0] == 1.0) in_contact[uz(c.node[0])] = 1;
        EXPECT_LE(c.gap, 0.0);
      }
      // Against the referee: every node that is inside a tet of the target at the end.
      Index inside = 0, seen = 0;
      for (Index i = model.bodies[1].nodes.begin; i < model.bodies[1].nodes.end; ++i) {
        bool in = false;
        for (Index t = 0; t < model.bodies[0].tets.end && !in; ++t) {
          const Tet& e = model.tets[uz(t)];
          const Vec3 &a = to[uz(e[0])], &b = to[uz(e[1])], &c = to[uz(e[2])], &d = to[uz(e[3])];
          const Vec3& p = to[uz(i)];
          in = signed_volume(p, b, c, d) > 0 && signed_volume(a, p, c, d) > 0 &&
               signed_volume(a, b, p, d) > 0 && signed_volume(a, b, c, p) > 0;
        }
        inside += in;
        seen += in && in_contact[uz(i)];
      }
      EXPECT_EQ(seen, inside) << speed;
      all_inside += inside;
    }
    EXPECT_GT(all_inside, sanitized ? 5 : 80);
  }
}

TEST(SurfaceContacts, TheGradientOfTheGapIsNormalTimesWeight) {
  const TetMesh ball = sphere(0.05, 3);
  const Model model = surface_pair_model({ball, moved(ball, Vec3(0.001, 0.0975, 0.002))});
  const std::vector<Vec3>& x = model.rest_position;
  std::size_t tried = 0;
  for (const Contact& c : contacts_of(model, x, x, 0.004)) {
    for (std::size_t a = 0; a < 4; ++a) {
      for (int k = 0; k < 3; ++k) {
        constexpr double h = 1e-8;
        const auto gap = [&](double by) {
          std::vector<Vec3> y = x;
          y[uz(c.node[a])][k] += by;
          for (const Contact& d : contacts_of(model, y, y, 0.004)) {
            if (d.id == c.id) return d.gap;
          }
          return std::nan("");
        };
        EXPECT_NEAR((gap(h) - gap(-h)) / (2 * h), c.weight[a] * c.normal[k], 1e-5);
        ++tried;
      }
    }
  }
  EXPECT_GT(tried, 50u);
}

TEST(SurfaceContacts, TheOrderOfTheBodiesDoesNotMatter) {
  const TetMesh ball = sphere(0.05, 3);
  const TetMesh cube = moved(box(Vec3(0.1, 0.1, 0.1), {3, 3, 3}), Vec3(0.01, 0.0985, 0.02));
  const Model one = surface_pair_model({ball, cube}), two = surface_pair_model({cube, ball});
  const auto gaps = [](const Model& m) {
    std::vector<double> g;
    for (const Contact& c : contacts_of(m, m.rest_position, m.rest_position, 0.003)) {
      g.push_back(c.gap);
    }
    std::sort(g.begin(), g.end());
    return g;
  };
  const std::vector<double> a = gaps(one), b = gaps(two);
  ASSERT_EQ(a.size(), b.size());
  EXPECT_GT(a.size(), 4u);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-12);
}

TEST(SurfaceContacts, ABeamThatIsBentTouchesItself) {
  // Bent to a ring: a full turn of the middle line, and a little more.
  const TetMesh straight = beam(Vec3(0.02, 0.02, 0.4), {2, 2, 40});
  const Model model = surface_pair_model({straight});
  const auto bent = [&](double turn) {  // [rad]
    std::vector<Vec3> x = model.rest_position;
    const double radius = 0.4 / turn;
    for (Vec3& p : x) {
      const double angle = p.z() / radius;
      p = Vec3(p.x(), (radius + p.y()) * std::cos(angle), (radius + p.y()) * std::sin(angle));
    }
    return x;
  };
  const double pi = std::acos(-1.0);
  EXPECT_TRUE(contacts_of(model, bent(0.5 * pi), bent(0.5 * pi)).empty());
  EXPECT_TRUE(contacts_of(model, bent(1.9 * pi), bent(1.95 * pi)).empty());
  EXPECT_GE(contacts_of(model, bent(1.999 * pi), bent(2.002 * pi)).size(), 9u);
}

TEST(SurfaceContacts, TheArmsOfAUTouchWhenTheyClose) {
  // Three boxes of one mesh: two arms and what joins them.
  TetMesh u = box(Vec3(0.12, 0.12, 0.03), {12, 12, 3});
  std::vector<Tet> kept;
  for (const Tet& t : u.tets) {
    const Vec3 c =
        0.25 * (u.nodes[uz(t[0])] + u.nodes[uz(t[1])] + u.nodes[uz(t[2])] + u.nodes[uz(t[3])]);
    if (std::abs(c.x()) > 0.01 || c.y() < -0.02) kept.push_back(t);
  }
  u.tets = kept;
  std::vector<Index> number(u.nodes.size(), -1);
  std::vector<Vec3> nodes;
  for (Tet& t : u.tets) {
    for (Index& i : t) {
      if (number[uz(i)] < 0) {
        number[uz(i)] = static_cast<Index>(nodes.size());
        nodes.push_back(u.nodes[uz(i)]);
      }
      i = number[uz(i)];
    }
  }
  u.nodes = nodes;
  const Model model = surface_pair_model({u});
  const auto closed = [&](double by) {  // at the arms' ends
    std::vector<Vec3> x = model.rest_position;
    for (Vec3& p : x) {
      const double share = std::max(0.0, (p.y() + 0.02) / 0.08);
      p.x() -= std::copysign(share * share * by, p.x()) * (std::abs(p.x()) > 1e-9 ? 1.0 : 0.0);
    }
    return x;
  };
  for (const double reach : {0.0, 0.001}) {
    EXPECT_TRUE(contacts_of(model, closed(0.0), closed(0.0), reach).empty());
    EXPECT_TRUE(contacts_of(model, closed(0.008), closed(0.0085), reach).empty());
    EXPECT_GE(contacts_of(model, closed(0.0099), closed(0.0103), reach).size(), 8u);
  }
  EXPECT_GE(contacts_of(model, closed(0.0105), closed(0.0105)).size(), 8u);  // still inside
  EXPECT_GE(contacts_of(model, closed(0.0), closed(0.02)).size(), 8u);       // in one leap
  for (const Contact& c : contacts_of(model, closed(0.0), closed(0.02))) EXPECT_LT(c.gap, 0.0);
}

TEST(SurfaceContacts, WhatHasNoAreaGivesNoNonsense) {
  const TetMesh cube = box(Vec3(0.1, 0.1, 0.1), {3, 3, 3});
  const Model model = surface_pair_model({cube, moved(cube, Vec3(0.01, 0.0999, 0.013))});
  std::vector<std::vector<Vec3>> ends(4, model.rest_position);
  for (std::size_t i = 0; i < ends[0].size(); ++i) {
    ends[0][i] = Vec3::Zero();
    ends[1][i].y() = 0.05;
    ends[2][i].x() = ends[2][i].z() = 0.0;
    ends[3][i] = Vec3::Constant(i % 7 == 0 ? std::nan("") : 1e200);
  }
  SurfaceContacts contacts(model);
  std::vector<Contact> found;
  for (const auto& from : ends) {
    for (const auto& to : ends) {
      for (const double reach : {0.0, 0.01}) {
        contacts.find(from, to, reach, found);
        for (const Contact& c : found) {
          if (&to == &ends[3] || &from == &ends[3]) continue;
          EXPECT_TRUE(std::isfinite(c.gap) && c.normal.allFinite());
          EXPECT_NEAR(c.normal.norm(), 1.0, 1e-9);
        }
      }
    }
  }
  contacts.find(model.rest_position, model.rest_position, 1e-3, found);
  EXPECT_GT(found.size(), 8u);  // and it goes on as if nothing had been
}

}  // namespace
}  // namespace sinew
