#include "sinew/sim/world.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "sinew/forces/terms.h"
#include "sinew/scene/scene.h"
#include "sinew/sim/internals.h"

namespace sinew::sim {
namespace {

Scene hanging_box(const std::vector<std::string>& overrides = {}) {
  return parse_scene(R"(
[body.box]
shape = "box"
cells = [3, 3, 3]
size = [0.1, 0.1, 0.1]
young = 2e4
[pin.top]
select = { side = "+y" }
)",
                     "hanging.toml", ".", overrides);
}

double total_energy(World& w) {
  return measure_energies(w.model(), w.controls(), w.state(),
                          w.stepping().forces().evaluate(w.controls(), w.state()).force)
      .total();
}

TEST(World, GoesOnFrameByFrameAndStopsWithinOne) {
  Simulation simulation = simulate(hanging_box());
  World& w = internals(simulation);
  EXPECT_TRUE(w.advance_frame(nullptr));
  EXPECT_NEAR(w.state().time, 1.0 / 30.0, 1e-15);
  const std::int64_t steps = w.state().step;
  EXPECT_FALSE(w.advance_frame(nullptr, Clock::now() - std::chrono::seconds(1)));
  const std::atomic<bool> stop{true};
  EXPECT_FALSE(w.advance_frame(&stop));
  EXPECT_EQ(w.state().step, steps + 2);
  EXPECT_TRUE(w.advance_frame(nullptr));
  EXPECT_NEAR(w.state().time, 2.0 / 30.0, 1e-15);
}

TEST(World, IsSteppedAsItsOwnerSaysAndStartsWhereItSays) {
  WorldOptions options;
  options.stepping = [](const Scene& scene) {
    SteppingOptions o = stepping_options(scene);
    o.interval = 0.01;
    o.stepper = StepperKind::implicit;
    return o;
  };
  std::size_t bodies = 0;
  options.start = [&](const Model& model, const BuildReport& report) {
    bodies = report.bodies.size();
    RunState run;
    run.state = initial_state(model);
    run.state.half_velocity.assign(run.state.position.size(), Vec3(0.0, 1.0, 0.0));
    return run;
  };
  Simulation simulation = simulate(hanging_box({"gravity=[0,0,0]"}), options);
  World& w = internals(simulation);
  EXPECT_EQ(bodies, 1U);
  EXPECT_EQ(w.run().stepper, StepperKind::implicit);
  EXPECT_TRUE(w.advance_frame(nullptr));
  EXPECT_NEAR(w.state().time, 0.01, 1e-15);
  double highest = 0.0;
  for (Index i = 0; i < w.body_nodes(); ++i)
    highest = std::max(highest, w.state().position[uz(i)].y() - w.model().rest_position[uz(i)].y());
  EXPECT_GT(highest, 1e-3);
  EXPECT_EQ(w.stepping().frame_count(), 200);
}

TEST(World, AToolPressesAndItsWorkIsInTheAccount) {
  Simulation simulation = simulate(
      hanging_box({"gravity=[0,0,0]", "box.damping_ratio=0", "safety=0.3", "stepper=verlet"}));
  World& w = internals(simulation);
  const ToolHandle tool = w.add_tool(Vec3(0.09, -0.03, 0), 0.03, 2e6);
  EXPECT_EQ(w.controls().tools.size(), 1U);
  EXPECT_TRUE(w.model().obstacles.empty());
  EXPECT_TRUE(w.scene().obstacles.empty());
  const auto now = [&] {
    return soft_sphere(w.controls().tools[w.index_of(tool)], w.state().time);
  };
  for (int i = 0; i < 20; ++i) {
    const double x = 0.09 - 0.0015 * i;
    w.move(tool, Vec3(x, -0.03, 0), 1.0 / 30.0);
    EXPECT_TRUE(w.advance_frame(nullptr));
    EXPECT_NEAR(now().center.x(), x, 1e-12);
  }
  const SoftReading reading = read_soft_sphere(w.model(), now(), w.state().position);
  EXPECT_GT(reading.force.x(), 0.0);
  EXPECT_GT(reading.depth, 0.0);
  w.reshape(tool, 0.031, 2e6);
  const double work = w.state().energy.work_in;
  EXPECT_GT(work, 0.0);
  w.remove(tool);
  EXPECT_TRUE(w.controls().tools.empty());
  EXPECT_NEAR(total_energy(w), 0.0, 0.05 * work);
  EXPECT_THROW(w.index_of(tool), Error);
}

TEST(World, NothingThatMovesWritesTheModel) {
  Simulation simulation = simulate(parse_scene(R"(
[body.box]
shape = "box"
size = [0.1, 0.1, 0.1]
[pin.top]
select = { side = "+y" }
path = [{ time = 1, move = [0, 0.01, 0] }]
[obstacle.table]
shape = "plane"
center = [0, -0.1, 0]
[obstacle.ball]
center = [0, -0.2, 0]
radius = 0.05
stiffness = "soft"
)",
                                               "moved.toml", "."));
  World& w = internals(simulation);
  const std::uint64_t hash = w.model().hash();
  const auto place_of = [&](Index obstacle) {
    return obstacle_pose(w.model(), w.controls(), obstacle, w.state().time).center;
  };
  w.move(w.pin("top"), RigidMotion{{0.0, 0.002, 0.0}, {}});
  w.move(w.obstacle("table"), Pose{Vec3(0, -0.09, 0), Mat3::Identity()});
  w.place(w.obstacle("ball"), Pose{Vec3(0, -0.3, 0), Mat3::Identity()});
  const ToolHandle tool = w.add_tool(Vec3(0.2, 0, 0), 0.03, 1e6);
  w.move(tool, Vec3(0.1, 0, 0), 1.0);
  w.step();
  EXPECT_LT((place_of(0) - Vec3(0, -0.09, 0)).norm(), 1e-12);
  EXPECT_LT((place_of(1) - Vec3(0, -0.3, 0)).norm(), 1e-12);

  const std::string saved = w.save();
  const double x = soft_sphere(w.controls().tools[0], 0.5).center.x();
  w.place(w.obstacle("table"), Pose{Vec3(0, -1, 0), Mat3::Identity()});
  w.move(tool, Vec3(0.9, 0, 0), 1.0);
  w.restore(saved);
  EXPECT_LT((place_of(0) - Vec3(0, -0.09, 0)).norm(), 1e-12);
  EXPECT_EQ(soft_sphere(w.controls().tools[0], 0.5).center.x(), x);
  EXPECT_EQ(w.model().hash(), hash);
}

TEST(World, GrabsAndToolsStayWhenValuesChange) {
  Simulation simulation = simulate(hanging_box());
  World& w = internals(simulation);
  w.advance_frame(nullptr);
  const Vec3 hand = w.state().position[0] + Vec3(0.01, 0, 0);
  const GrabHandle grab = w.grab(0, 0.03, hand);
  EXPECT_LT(w.force(grab).norm(), 1e-12);
  EXPECT_LT((w.unloaded_target(grab) - hand).norm(), 1e-12);
  const ToolHandle tool = w.add_tool(Vec3(0.3, 0, 0), 0.03, 1e6);
  w.set_gravity(Vec3(0, 0, 1));
  const std::vector<Vec3> before = w.state().position;
  w.change({"box.young=5e4", "stepper=implicit"});
  EXPECT_EQ(w.state().position, before);
  EXPECT_EQ(w.run().stepper, StepperKind::implicit);
  EXPECT_EQ(w.scene().bodies[0].material.young, 5e4);
  EXPECT_EQ(w.controls().gravity, Vec3(0, 0, 1));
  EXPECT_EQ(w.current_scene().gravity, Vec3(0, 0, 1));
  EXPECT_LT((w.target(grab) - hand).norm(), 1e-12);
  EXPECT_EQ(w.controls().tools[w.index_of(tool)].radius, 0.03);
  EXPECT_THROW(w.change({"box.young=-1"}), Error);
  EXPECT_EQ(w.scene().bodies[0].material.young, 5e4);
  w.forget_steps();
  EXPECT_FALSE(w.scene().names_steps);
  EXPECT_EQ(w.run().stepper, StepperKind::verlet);
  w.advance_frame(nullptr);

  w.reset();
  EXPECT_EQ(w.state().time, 0.0);
  EXPECT_EQ(w.state().position, w.model().rest_position);
  EXPECT_EQ(w.controls().gravity, Vec3(0, 0, 1));
  EXPECT_TRUE(w.grabs().empty());
  EXPECT_TRUE(w.controls().tools.empty());
  w.advance_frame(nullptr);
}

TEST(World, AnotherOneGoesOnWithTheSameBits) {
  Simulation first = simulate(hanging_box({"stepper=verlet"}));
  World& a = internals(first);
  a.advance_frame(nullptr);
  const GrabHandle grab = a.grab(5, 0.03, a.state().position[5]);
  const ToolHandle tool = a.add_tool(Vec3(0.07, -0.03, 0), 0.03, 1e6);
  a.step();
  Simulation second = simulate(a.current_scene());
  World& b = internals(second);
  a.choose_steps();
  b.continue_from(a);
  for (int i = 0; i < 3; ++i) {
    for (World* w : {&a, &b}) {
      w->move(w->counterpart(grab), Vec3(0.01 * i, -0.06, 0));
      w->move(w->counterpart(tool), Vec3(0.07 - 0.002 * i, -0.03, 0), 0.03);
      w->advance_frame(nullptr);
    }
    EXPECT_EQ(a.state().hash(), b.state().hash());
  }
  EXPECT_GT(a.force(grab).norm(), 0.0);
}

TEST(World, ARunThatDivergesIsPutBackToWhatWasKept) {
  Simulation simulation =
      simulate(hanging_box({"dt=0.01", "allow_unstable=true", "box.law=lloyd"}));
  World& w = internals(simulation);
  w.advance_frame(nullptr);
  w.keep();
  const std::uint64_t kept = w.state().hash();
  const std::int64_t frame = w.run().frame;
  EXPECT_THROW(
      {
        for (int i = 0; i < 2000; ++i) w.advance_frame(nullptr);
      },
      Error);
  EXPECT_EQ(w.state().hash(), kept);
  EXPECT_EQ(w.run().frame, frame);
}

}  // namespace
}  // namespace sinew::sim
