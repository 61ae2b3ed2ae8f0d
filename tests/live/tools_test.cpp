// The tools of the live view: ball, cut, springs, the compared body, the state as a file.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "sinew/base/error.h"
#include "sinew/io/vtu.h"
#include "sinew/live/simulation.h"
#include "sinew/scene/laws.h"
#include "sinew/scene/parse.h"
#include "tests/live/support.h"
#include "tests/support/source_dir.h"

namespace sinew::live {
namespace {

using test::finite;
using test::frames;
using test::never;

TEST(Ball, PushesTheTissueAndIsPushedBack) {
  for (const char* stepper : {"verlet", "implicit"}) {
    Simulation s(test::hanging_box({std::string("stepper=") + stepper}));
    frames(s, 60);
    s.apply(MoveBall{Vec3(0.1, -0.03, 0), 0.03});
    frames(s, 10);
    ASSERT_TRUE(s.status().ball.has_value());
    EXPECT_NEAR(s.status().ball->radius, 0.03, 1e-12) << stepper;
    EXPECT_EQ(s.status().ball->contacts, 0) << stepper;
    s.apply(MoveBall{Vec3(0.06, -0.03, 0), 0.0});
    frames(s, 60);
    const Status pressed = s.status();
    EXPECT_LT((pressed.ball->center - Vec3(0.06, -0.03, 0)).norm(), 1e-12) << stepper;
    EXPECT_GT(pressed.ball->force.x(), 0.05) << stepper;
    EXPECT_GT(pressed.ball->contacts, 0) << stepper;
    EXPECT_GT(pressed.energy.work_in, 0.0) << stepper;
    EXPECT_FALSE(s.frame().contact.empty()) << stepper;
    s.apply(RemoveBall{});
    frames(s, 120);
    EXPECT_FALSE(s.status().ball.has_value()) << stepper;
    EXPECT_TRUE(s.frame().contact.empty()) << stepper;
    EXPECT_TRUE(s.status().error.empty()) << stepper << s.status().error;
  }
}

TEST(Ball, WhatItDoesIsInTheEnergyAccount) {
  // Steps of a third of the stable one: Verlet's own energy swings with the square of the step.
  Simulation s(test::hanging_box({"gravity=[0,0,0]", "box.damping_ratio=0", "safety=0.3"}));
  s.apply(MoveBall{Vec3(0.1, -0.03, 0), 0.03});
  for (int i = 0; i < 30; ++i) {
    s.apply(MoveBall{Vec3(0.1 - 0.0013 * i, -0.03, 0), 0.0});
    frames(s, 1);
  }
  s.apply(RemoveBall{});
  const Energies e = s.status().energy;
  EXPECT_GT(e.work_in, 0.0);
  EXPECT_NEAR(e.total(), 0.0, 0.05 * e.work_in);
}

TEST(Ball, PutIntoTheTissueOrThrownAboutItTearsNothing) {
  for (const char* young : {"3e3", "1e6"}) {
    Simulation s(test::hanging_box({std::string("box.young=") + young}));
    s.apply(MoveBall{Vec3(0, 0, 0), 0.04});  // in the middle of it
    frames(s, 20);
    for (int i = 0; i < 20; ++i) {
      s.apply(MoveBall{Vec3(i % 2 == 0 ? 5.0 : -0.05, -0.02, 0), 0.0});
      frames(s, 3);
    }
    s.apply(SetMaterial{"", "", "young", "1e5"});
    frames(s, 5);
    EXPECT_TRUE(s.status().error.empty()) << s.status().error;
    EXPECT_TRUE(finite(s));
    EXPECT_LT(s.status().max_stretch, 2.0) << young;
  }
}

TEST(Hands, ThatJumpTearNothing) {
  Simulation s(test::hanging_box({"box.young=3e3"}));
  s.apply(Play{});
  for (int i = 0; i < 12; ++i) {
    s.apply(Grab{0, 20, s.state().position[uz(s.topology()->node[20])], 0.0});
    s.apply(Drag{0, Vec3(i % 2 == 0 ? 0.3 : -0.3, 0.2, 0.1 * i)});
    frames(s, 10);
  }
  EXPECT_TRUE(s.running()) << s.status().error;
  EXPECT_TRUE(finite(s));
}

TEST(Cut, LeavesTheTetsOnOneSide) {
  Simulation s(test::hanging_box());
  const std::uint32_t revision = s.topology()->revision;
  s.apply(SetCut{{Vec3(1, 0, 0), 0.0}});
  const Topology& t = *s.topology();
  EXPECT_EQ(t.revision, revision + 1);
  EXPECT_EQ(s.frame().revision, revision + 1);
  EXPECT_EQ(s.frame().position.size(), 3 * t.node.size());
  for (std::size_t i = 0; i < t.node.size(); ++i) EXPECT_LT(t.rest[3 * i], 0.03F);
  // Closed: every edge has a twin that runs the other way.
  std::map<std::pair<unsigned, unsigned>, int> edges;
  for (std::size_t k = 0; k < t.triangle.size(); k += 3) {
    for (std::size_t c = 0; c < 3; ++c) {
      const unsigned a = t.triangle[k + c];
      const unsigned b = t.triangle[k + (c + 1) % 3];
      ++edges[{a, b}];
      --edges[{b, a}];
    }
  }
  for (const auto& [edge, count] : edges) EXPECT_EQ(count, 0);
  EXPECT_NEAR(t.diagonal, 0.1 * std::sqrt(3.0), 1e-6);  // of the whole body

  s.apply(SetCut{{Vec3(1, 0, 0), -100.0}});  // would leave nothing
  EXPECT_EQ(s.topology()->triangle.size(), 12u);
  s.apply(SetCut{});
  EXPECT_EQ(s.topology()->node.size(), 56u);
  EXPECT_THROW(s.apply(SetCut{{Vec3(std::nan(""), 0, 0), 0.0}}), Error);
}

TEST(Springs, ShowAllNodes) {
  Simulation s(test::hanging_box());
  EXPECT_TRUE(s.topology()->spring.empty());
  s.apply(SetSprings{true});
  const Topology& t = *s.topology();
  EXPECT_EQ(t.node.size(), 64u);
  EXPECT_EQ(t.spring.size(), 2 * uz(s.model().spring_count()));
  EXPECT_TRUE(s.parameters()->springs_shown);
  for (const Quantity q : {Quantity::stretch, Quantity::stress, Quantity::region}) {
    s.apply(SetQuantity{q});
    EXPECT_EQ(s.frame().value.size(), 64u);
  }
}

TEST(Springs, OfAttachmentsHaveTheirAnchors) {
  const Scene scene = load_scene(test::source_path("scenes/ligament.toml"));
  Simulation s(scene);
  s.apply(SetSprings{true});
  const Topology& t = *s.topology();
  EXPECT_EQ(static_cast<Index>(t.node.size()), s.model().node_count());
  for (std::size_t q = 0; q < quantities.size(); ++q) {
    s.apply(SetQuantity{static_cast<Quantity>(q)});
    EXPECT_EQ(s.frame().value.size(), t.node.size());
  }
}

// The same law again is the same body, bit by bit, whatever is done to it.
TEST(Compare, WithItsOwnLawThereIsNoDistance) {
  Simulation s(test::hanging_box({"stepper=verlet"}));
  frames(s, 5);
  s.apply(SetCompare{"neo-hookean"});
  s.apply(Grab{0, 3, s.state().position[uz(s.topology()->node[3])], 0.0});
  for (int i = 0; i < 20; ++i) {
    s.apply(Drag{0, Vec3(0.003 * i, -0.05, 0)});
    if (i == 10) s.apply(SetMaterial{"", "", "young", "4e4"});
    if (i == 12) s.apply(SetGravity{Vec3(0, 0, 9.81)});
    if (i == 14) s.apply(MoveBall{Vec3(0.06, -0.03, 0), 0.03});
    frames(s, 1);
    const Frame f = s.frame();
    ASSERT_EQ(f.compared, f.position) << i;
  }
  EXPECT_EQ(s.status().distance->largest, 0.0);
}

TEST(Compare, AnotherLawIsInLockStep) {
  Simulation s(test::hanging_box());
  for (const LawChoice& law : law_choices()) {
    s.apply(SetCompare{law.name});
    EXPECT_EQ(s.parameters()->compare, law.name);
    frames(s, 10);
    EXPECT_TRUE(s.status().error.empty()) << s.status().error;
  }
  s.apply(SetCompare{"lloyd"});
  s.apply(SetQuantity{Quantity::distance});
  frames(s, 20);
  const Status status = s.status();
  ASSERT_TRUE(status.distance.has_value());
  EXPECT_GT(status.distance->largest, 1e-4);
  EXPECT_GT(status.distance->largest, status.distance->mean);
  const Frame f = s.frame();
  ASSERT_EQ(f.compared.size(), f.position.size());
  const float most = *std::max_element(f.value.begin(), f.value.end());
  EXPECT_GT(most, 1e-4F);
  s.apply(Advance{});  // one step: the other follows
  EXPECT_FALSE(s.frame().compared.empty());
  s.apply(Reset{});
  EXPECT_EQ(s.status().distance->largest, 0.0);
  s.apply(SetCompare{});
  EXPECT_TRUE(s.frame().compared.empty());
  EXPECT_FALSE(s.status().distance.has_value());
  EXPECT_THROW(s.apply(SetCompare{"magic"}), Error);
}

TEST(Compare, SlicesOfAFrameShowBothAtTheSameTime) {
  Simulation s(test::hanging_box({"box.young=1e8"}));
  s.apply(SetCompare{"neo-hookean"});
  for (int i = 0; i < 50; ++i) {
    s.advance(Clock::now());  // one step, or a few
    const Frame f = s.frame();
    ASSERT_EQ(f.compared, f.position);
  }
}

TEST(Compare, EndsWithAnotherScene) {
  Simulation s(test::hanging_box());
  s.apply(SetCompare{"fem"});
  s.apply(Load{test::hanging_box({"box.cells=[2,2,2]"})});
  EXPECT_TRUE(s.parameters()->compare.empty());
  EXPECT_EQ(s.parameters()->opened, 2u);
  frames(s, 1);
}

TEST(LiveSteps, AreImplicitWhereExplicitOnesCannotKeepPace) {
  Simulation s(test::hanging_box({"box.cells=[8,8,8]", "box.young=1e3"}));
  EXPECT_EQ(s.parameters()->stepper, "live");
  s.apply(SetMaterial{"", "", "young", "1e9"});
  EXPECT_EQ(s.status().stepper, StepperKind::implicit);
  EXPECT_FALSE(s.status().reason.empty());
  s.apply(SetCompare{"fem"});
  frames(s, 3);
  EXPECT_EQ(s.frame().compared.empty(), false);
  s.apply(SetStepping{"stepper", "verlet"});
  EXPECT_EQ(s.parameters()->stepper, "verlet");
  EXPECT_EQ(s.status().stepper, StepperKind::verlet);
  s.apply(SetStepping{"stepper", "live"});
  EXPECT_EQ(s.parameters()->stepper, "live");
  EXPECT_EQ(s.status().stepper, StepperKind::implicit);
  s.apply(SetMaterial{"", "", "young", "1e3"});
  EXPECT_EQ(s.parameters()->document.find("stepper"), std::string::npos);
}

TEST(Contacts, OnTheGround) {
  Simulation s(load_scene(test::source_path("scenes/drop.toml")));
  EXPECT_TRUE(s.frame().contact.empty());
  for (int i = 0; i < 120 && s.frame().contact.empty(); ++i) frames(s, 1);
  EXPECT_FALSE(s.frame().contact.empty());
}

TEST(Contacts, OfBodiesWithEachOtherAndWithHardObstacles) {
  const auto cubes = [](const std::string& more) {
    return parse_scene(
        more +
            "[body.low]\nshape = \"box\"\nsize = [0.1, 0.1, 0.1]\ncells = [2, 2, 2]\n"
            "[pin.low]\nbody = \"low\"\nselect = { all = true }\n"
            "[body.high]\nshape = \"box\"\nsize = [0.06, 0.06, 0.06]\ncells = [2, 2, 2]\n"
            "position = [0, 0.085, 0]\n",
        "scene.toml", ".");
  };
  Simulation alone(cubes(""));
  frames(alone, 12);
  EXPECT_TRUE(alone.frame().contact.empty());
  EXPECT_EQ(alone.status().counters.deepest, 0.0);

  Simulation s(cubes("[contact]\n"));
  EXPECT_TRUE(s.frame().contact.empty());
  frames(s, 12);
  const Frame frame = s.frame();
  ASSERT_EQ(frame.contact.size(), s.topology()->node.size());
  int low = 0, high = 0;
  for (std::size_t i = 0; i < frame.contact.size(); ++i) {
    const bool of_low = s.topology()->node[i] < s.model().bodies[0].nodes.end;
    (of_low ? low : high) += frame.contact[i];
    if (frame.contact[i] != 0) {
      EXPECT_NEAR(frame.position[3 * i + 1], 0.05, 0.01);
    }
  }
  EXPECT_GT(low, 0);
  EXPECT_GE(high, 4);
  EXPECT_GT(s.status().counters.contacts, 0);
  EXPECT_LT(s.status().counters.deepest, 1e-3);

  Simulation table(parse_scene(
      "[obstacle.table]\nshape = \"box\"\ncenter = [0, -0.02, 0]\nsize = [0.4, 0.04, 0.4]\n"
      "[body.high]\nshape = \"box\"\nsize = [0.06, 0.06, 0.06]\ncells = [2, 2, 2]\n"
      "position = [0, 0.035, 0]\n",
      "scene.toml", "."));
  frames(table, 12);
  EXPECT_FALSE(table.frame().contact.empty());
}

TEST(Status, HasProbesAndObstacles) {
  Simulation s(load_scene(test::source_path("scenes/press.toml")));
  ASSERT_EQ(s.parameters()->obstacles.size(), 1u);
  EXPECT_EQ(s.parameters()->obstacles[0].radius, 0.03);
  s.apply(MoveBall{Vec3(0, 1, 0), 0.01});
  frames(s, 10);
  const Status status = s.status();
  ASSERT_EQ(status.obstacles.size(), 1u);
  EXPECT_LT(status.obstacles[0].center.y(), 0.05);
  EXPECT_EQ(status.probes.size(), 1u);
  EXPECT_GT(status.ball->center.y(), 0.5);
}

TEST(SaveState, IsAMeshThatCanBeRead) {
  Simulation s(test::hanging_box());
  frames(s, 10);
  std::string bytes;
  s.apply(SaveState{[&](std::string b) { bytes = std::move(b); }});
  const TetMesh mesh = io::parse_vtu(bytes, "state.vtu");
  ASSERT_EQ(mesh.nodes.size(), 64u);
  EXPECT_LT((mesh.nodes[20] - s.state().position[20]).norm(), 1e-6);
}

}  // namespace
}  // namespace sinew::live
