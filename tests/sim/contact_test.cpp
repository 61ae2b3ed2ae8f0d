// Bodies that touch, whole runs: what docs/methods/contact.md promises.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>

#include "sinew/base/parallel.h"
#include "sinew/contact/overlaps.h"
#include "sinew/forces/terms.h"
#include "sinew/scene/build.h"
#include "sinew/sim/checkpoint.h"
#include "sinew/sim/obstacle_reading.h"
#include "sinew/sim/stepping.h"
#include "tests/support/source_dir.h"

namespace sinew {
namespace {

constexpr double g = 9.81;

// A run that is looked at frame by frame.
struct ContactRun {
  explicit ContactRun(const Scene& s)
      : scene(s),
        model(build_model(scene)),
        controls(initial_controls(model)),
        run(start(model)),
        stepping(scene, model, controls, run) {}
  static RunState start(const Model& model) {
    RunState run;
    run.state = initial_state(model);
    return run;
  }
  void to_the_end() {
    while (run.frame < stepping.frame_count()) stepping.advance_frame(controls, run, nullptr);
  }
  Vec3 center(std::size_t body) const { return mean(body, run.state.position); }
  Vec3 velocity(std::size_t body) const { return mean(body, run.state.half_velocity); }
  Vec3 mean(std::size_t body, const std::vector<Vec3>& v) const {
    Vec3 sum = Vec3::Zero();
    double mass = 0.0;
    for (Index i = model.bodies[body].nodes.begin; i < model.bodies[body].nodes.end; ++i) {
      sum += model.mass[uz(i)] * v[uz(i)];
      mass += model.mass[uz(i)];
    }
    return sum / mass;
  }
  Vec3 momentum() const {
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < model.mass.size(); ++i) {
      sum += model.mass[i] * run.state.half_velocity[i];
    }
    return sum;
  }
  double energy() {
    return measure_energies(model, controls, run.state,
                            stepping.forces().evaluate(controls, run.state).force)
        .total();
  }

  Scene scene;
  Model model;
  Controls controls;
  RunState run;
  Stepping stepping;
};

Scene contact_scene(const std::string& text) {
  return parse_scene(text, "contact.toml", ".");
}

std::string cube(const std::string& name, const std::string& keys) {
  return "[body." + name +
         "]\nshape = \"box\"\nsize = [0.02, 0.02, 0.02]\ncells = [2, 2, 2]\n"
         "poisson = 0.4\ndensity = 1000\n" +
         keys + "\n";
}

TEST(Contact, TenCubesStandOnEachOther) {
#ifdef SINEW_SANITIZED
  const std::string duration = "duration=0.05";  // two minutes of wall time otherwise
#else
  const std::string duration = "duration=0.5";
#endif
  ContactRun r(load_scene(test::source_path("scenes/stack.toml"), {duration}));
  std::vector<Vec3> before;
  for (std::size_t b = 0; b < 10; ++b) before.push_back(r.center(b));
  r.to_the_end();
  for (std::size_t b = 0; b < 10; ++b) {
    const Vec3 displacement = r.center(b) - before[b];
    EXPECT_LT(std::hypot(displacement.x(), displacement.z()), 5e-5) << b;
    EXPECT_LT(std::abs(displacement.y()), 5e-4) << b;
  }
  EXPECT_GT(r.run.contacts, 9 * 16);
  EXPECT_LT(r.run.deepest, 0.01 * 0.02 / 3.0);  // 1 % of an edge
  EXPECT_TRUE(find_overlaps(r.model, r.run.state.position, 6e-5).empty());
}

// Free flight: what one body loses the other gets, and nothing comes from nowhere.
TEST(Contact, BodiesThatCollideKeepTheirMomentum) {
  for (const std::string stepper : {"verlet", "implicit"}) {
    ContactRun r(contact_scene("duration = 0.05\ngravity = [0, 0, 0]\nstepper = \"" + stepper +
                               "\"\n[contact]\n" + cube("a", "velocity = [1, 0, 0]") +
                               cube("b",
                                    "position = [0.025, 0.004, 0.003]\nvelocity = [-2, 0, 0]\n"
                                    "spin = [0, 20, 10]")));
    const Vec3 before = r.momentum();
    const double energy = r.energy();
    r.to_the_end();
    const double tolerance = stepper == "verlet" ? 1e-6 : 1e-5;
    EXPECT_LT((r.momentum() - before).norm(), tolerance * before.norm()) << stepper;
    EXPECT_GT(r.velocity(1).x(), -1.9) << stepper;  // they did meet
    EXPECT_GT(r.run.friction_work, 0.0) << stepper;
    const Energies e = measure_energies(
        r.model, initial_controls(r.model), r.run.state,
        r.stepping.forces().evaluate(initial_controls(r.model), r.run.state).force);
    EXPECT_LT(e.kinetic + e.elastic, energy) << stepper;
    // The account of impacts is of first order in the step.
    EXPECT_NEAR(e.total(), energy, (stepper == "verlet" ? 0.1 : 0.2) * energy) << stepper;
  }
}

// A slope of the ground at an angle; returns how far the body's centre moved in 0.4 s.
double way_down(double angle, double friction, const std::string& body) {
  const double s = std::sin(angle);
  const double c = std::cos(angle);
  ContactRun r(contact_scene("duration = 0.4\n[ground]\nnormal = [" + std::to_string(s) + ", " +
                             std::to_string(c) + ", 0]\nfriction = " + std::to_string(friction) +
                             "\n" + body + "position = [" + std::to_string(s * 0.03) + ", " +
                             std::to_string(c * 0.03) +
                             ", 0]\nyoung = 3e5\npoisson = 0.45\ndamping_ratio = 0.02\n"));
  const Vec3 before = r.center(0);
  r.to_the_end();
  return (r.center(0) - before).norm();
}

TEST(Contact, BallsRollAndSlideAsCoulombSays) {
  const std::string ball = "[body.ball]\nshape = \"sphere\"\nradius = 0.03\nresolution = 5\n";
  const double half_t2 = 0.5 * 0.4 * 0.4;
  // tan(angle) < 3.5 mu: it rolls, at 5/7 of g sin(angle). The gel and its facets cost a little.
  const double gentle = 20.0 * std::numbers::pi / 180.0;
  const double rolled = way_down(gentle, 0.2, ball);
  EXPECT_NEAR(rolled, 5.0 / 7.0 * g * std::sin(gentle) * half_t2, 0.03 * rolled);
  // Steeper, it slips; what it loses to friction gives mu.
  const double steep = 45.0 * std::numbers::pi / 180.0;
  const double a = way_down(steep, 0.2, ball) / half_t2;
  EXPECT_NEAR((g * std::sin(steep) - a) / (g * std::cos(steep)), 0.2, 0.02 * 0.2);
}

TEST(Contact, AFastBallDoesNotTunnelThroughAMembrane) {
  ContactRun r(contact_scene(R"(duration = 0.004
gravity = [0, 0, 0]
[output]
fps = 1000
[contact]
[body.membrane]
shape = "box"
size = [0.1, 0.003, 0.1]
cells = [12, 1, 12]
young = 1e7
poisson = 0.4
[pin.left]
body = "membrane"
select = { side = "-x" }
[pin.right]
body = "membrane"
select = { side = "+x" }
[body.ball]
shape = "sphere"
radius = 0.01
resolution = 2
position = [0.003, 0.02, 0.002]
velocity = [0, -50, 0]
young = 1e6
poisson = 0.4
)"));
  r.to_the_end();
  EXPECT_GT(r.center(1).y(), r.center(0).y());
  EXPECT_TRUE(find_overlaps(r.model, r.run.state.position, 1e-3).empty());
}

TEST(Contact, ImplicitAndExplicitStepsComeToTheSameRest) {
  std::vector<double> height;
  for (const std::string stepper : {"verlet", "implicit"}) {
    ContactRun r(contact_scene("duration = 0.6\nstepper = \"" + stepper +
                               "\"\n[ground]\n[contact]\n" +
                               cube("a", "position = [0, 0.01, 0]\ndamping_ratio = 0.5") +
                               cube("b",
                                    "position = [0, 0.03, 0]\nrotation = [0, 20, 0]\n"
                                    "damping_ratio = 0.5")));
    r.to_the_end();
    height.push_back(r.center(1).y());
    EXPECT_LT(r.velocity(1).norm(), 1e-3) << stepper;
  }
  EXPECT_LT(height[0], 0.03 - 1e-4);
  EXPECT_NEAR(height[0], height[1], 0.02 * (0.03 - height[1]));
}

// Contacts begin with what they pushed with in the step before: that is in the checkpoint too.
TEST(Contact, ARunThatIsCutGoesOnToTheSameBits) {
  const Scene scene = contact_scene(
      "duration = 0.1\n[ground]\n[contact]\n" + cube("a", "position = [0, 0.0101, 0]") +
      cube("b", "position = [0.003, 0.0302, 0]\nrotation = [0, 20, 0]") +
      "[obstacle.wall]\nshape = \"box\"\ncenter = [0.023, 0.03, 0]\n"
      "size = [0.02, 0.03, 0.04]\n");
  ContactRun whole(scene);
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    ContactRun cut(scene);
    while (cut.run.frame < 2) cut.stepping.advance_frame(cut.controls, cut.run, nullptr);
    EXPECT_GT(cut.run.state.reactions.contacts.size(), 10U);
    const auto file = std::filesystem::temp_directory_path() /
                      ("sinew-contact-" + std::to_string(::getpid()) + ".bin");
    write_checkpoint(file, cut.model.hash(), cut.run);
    ContactRun rest(scene);
    rest.run = read_checkpoint(file, rest.model);
    std::filesystem::remove(file);
    rest.to_the_end();
    hashes.push_back(rest.run.state.hash());
  }
  whole.to_the_end();
  EXPECT_EQ(hashes[0], whole.run.state.hash());
  EXPECT_EQ(hashes[1], whole.run.state.hash());
}

// What rests has no kinetic energy: the velocity of a whole step knows the contacts' forces.
TEST(Contact, WhatLiesStillHasNoKineticEnergy) {
  ContactRun r(contact_scene("duration = 1\n[ground]\n[contact]\n" +
                             cube("a", "position = [0, 0.01, 0]\ndamping_ratio = 0.5") +
                             cube("b", "position = [0, 0.03, 0]\ndamping_ratio = 0.5")));
  r.to_the_end();
  const Energies e =
      measure_energies(r.model, initial_controls(r.model), r.run.state,
                       r.stepping.forces().evaluate(initial_controls(r.model), r.run.state).force);
  EXPECT_LT(e.kinetic, 1e-3 * e.elastic);
  EXPECT_NEAR(e.total(), 0.0, 0.02 * std::abs(e.gravity));
}

// [ground] is a plane obstacle that no table lists.
TEST(Contact, TheGroundAndAPlaneObstacleGiveTheSameBitsWithEveryStepper) {
  const std::string slope = "normal = [0.1, 1, 0.05]\nfriction = 0.4\nrestitution = 0.3\n";
  const std::string flat = "friction = 0.4\n";
  for (const std::string stepper : {"verlet", "implicit", "static"}) {
    const std::string body =
        "duration = 0.2\nstepper = \"" + stepper +
        "\"\n[body.box]\nshape = \"box\"\nsize = [0.1, 0.1, 0.1]\ncells = [3, 3, 3]\n"
        "position = [0, 0.06, 0]\nvelocity = [0.2, 0, 0]\nyoung = 20e3\n";
    const std::string plane = stepper == "static" ? flat : slope;
    ContactRun ground(parse_scene(body + "[ground]\n" + plane, "ground.toml", "."));
    ContactRun obstacle(
        parse_scene(body + "[obstacle.floor]\nshape = \"plane\"\ncenter = [0, 0, 0]\n" + plane,
                    "plane.toml", "."));
    ground.to_the_end();
    obstacle.to_the_end();
    EXPECT_EQ(ground.run.state.hash(), obstacle.run.state.hash()) << stepper;
    EXPECT_GT(ground.run.contacts, 0) << stepper;
    ContactFinder on_ground(ground.model);
    ContactFinder on_plane(obstacle.model);
    EXPECT_EQ(read_obstacles(ground.model, ground.controls, ground.run.state, &on_ground).size(),
              0U);
    EXPECT_EQ(
        read_obstacles(obstacle.model, obstacle.controls, obstacle.run.state, &on_plane).size(),
        1U);
  }
}

// A step takes the box three to three hundred times the thickness of the obstacle that it hits, at
// any part of the step.
TEST(Contact, ImplicitStepsDoNotPassThroughThinObstacles) {
  const std::string plates[] = {
      "shape = \"box\"\nsize = [2, 1e-2, 2]\n", "shape = \"box\"\nsize = [2, 1e-4, 2]\n",
      "shape = \"cylinder\"\naxis = [0, 1, 0]\nradius = 1\nlength = 1e-3\n"};
  for (const std::string scheme : {"tr-bdf2", "sdirk2", "backward-euler"}) {
    for (const std::string& plate : plates) {
      for (const double height : {0.2, 0.205, 0.21, 0.215, 0.22}) {
        ContactRun r(parse_scene("duration = 0.5\nstepper = \"implicit\"\nscheme = \"" + scheme +
                                     "\"\ndt = 0.0166\n[body.box]\nshape = \"box\"\n"
                                     "size = [0.1, 0.1, 0.1]\ncells = [2, 2, 2]\nyoung = 20e3\n"
                                     "position = [0, " +
                                     std::to_string(height) + ", 0]\n[obstacle.plate]\n" +
                                     "center = [0, 0, 0]\n" + plate,
                                 "plate.toml", "."));
        r.to_the_end();
        EXPECT_GT(r.center(0).y(), 0.03) << scheme << " " << plate << height;
      }
    }
  }
}

}  // namespace
}  // namespace sinew
