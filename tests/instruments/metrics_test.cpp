#include <gtest/gtest.h>
#include <sinew/error.h>
#include <sinew/metrics.h>
#include <sinew/sinew.h>

namespace sinew {
namespace {

// A slab with a region "vessel" through its middle, along x.
Simulation slab() {
  return Simulation::from_text(R"(
gravity = [0, 0, 0]
[body.slab]
shape = "box"
size = [0.08, 0.04, 0.04]
cells = [8, 4, 4]
young = 5e3
density = 1060
[body.slab.region.vessel]
select = { box = { min = [-1, -0.011, -0.011], max = [1, 0.011, 0.011] } }
young = 20e3
[pin.table]
select = { side = "-y" }
[obstacle.finger]
shape = "sphere"
radius = 0.012
center = [0, 0.034, 0]
)");
}

TEST(Metrics, PathForceAndStretchOfAPress) {
  Simulation simulation = slab();
  Metrics metrics(simulation, {.force_limit = 0.2, .strain_limit = 0.2, .spared = {"vessel"}});
  const ObstacleHandle finger = simulation.obstacle("finger");
  for (int k = 1; k <= 100; ++k) {
    const double depth = 0.014 * (k <= 50 ? k : 100 - k) / 50.0;
    simulation.move(finger, {.center = {0.0, 0.034 - depth, 0.0}});
    simulation.advance(0.01);
    metrics.update();
  }
  ASSERT_EQ(metrics.tools().size(), 1u);
  const ToolMetrics& tool = metrics.tools()[0];
  EXPECT_NEAR(tool.path, 0.028, 1e-6);
  EXPECT_GT(tool.peak_force, 0.2);
  EXPECT_NEAR(tool.peak_time, 0.5, 0.05);
  EXPECT_GT(tool.contact_time, tool.time_above);
  EXPECT_GT(tool.time_above, 0.0);
  EXPECT_EQ(tool.forces_above, 1);
  EXPECT_GT(metrics.largest_strain(), 0.2);
  EXPECT_GT(metrics.peak_stretched(), metrics.stretched_share());
  EXPECT_EQ(metrics.spared()[0].cut_area, 0.0);
  EXPECT_NEAR(metrics.time(), 1.0, 1e-9);
  ASSERT_EQ(metrics.events().size(), 2u);
  EXPECT_NE(metrics.events_csv().find("force,finger"), std::string::npos);
  EXPECT_NE(metrics.events_csv().find("strain,slab"), std::string::npos);
  EXPECT_NE(metrics.json().find("\"peak_force\""), std::string::npos);
}

TEST(Metrics, ACutVesselIsAnEvent) {
  Simulation simulation = slab();
  Metrics metrics(simulation, {.spared = {"slab.vessel"}});
  CutDescription cut;
  cut.plane = CutDescription::Plane{{0.003, 0.0, 0.0}, {1.0, 0.0, 0.0}};
  simulation.cut(cut);
  metrics.update();
  EXPECT_NEAR(metrics.spared()[0].cut_area, 0.02 * 0.02, 0.25 * 0.02 * 0.02);
  ASSERT_EQ(metrics.events().size(), 1u);
  EXPECT_EQ(metrics.events()[0].what, "cut");
  EXPECT_EQ(metrics.events()[0].subject, "slab.vessel");
  simulation.undo();
  metrics.update();
  EXPECT_NEAR(metrics.spared()[0].cut_area, 0.0, 1e-12);
  EXPECT_EQ(metrics.events().size(), 1u);
}

TEST(Metrics, ChangeNothing) {
  Simulation a = slab(), b = slab();
  Metrics metrics(a, {});
  for (int k = 0; k < 10; ++k) {
    a.advance(0.01);
    b.advance(0.01);
    metrics.update();
  }
  EXPECT_EQ(a.hash(), b.hash());
}

TEST(Metrics, SayWhatIsNotThere) {
  const Simulation simulation = slab();
  EXPECT_THROW(Metrics(simulation, {.tools = {"thumb"}}), Error);
  EXPECT_THROW(Metrics(simulation, {.force_limit = 0.0}), Error);
  try {
    Metrics metrics(simulation, {.spared = {"artery"}});
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(error.remedy().find("slab.vessel"), std::string::npos);
  }
}

}  // namespace
}  // namespace sinew
