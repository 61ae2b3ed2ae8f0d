#include "sinew/scene/start_warnings.h"

#include <gtest/gtest.h>

#include "sinew/scene/build.h"

namespace sinew {
namespace {

// The warnings about the start of a box of 0.1 m around the origin.
std::vector<std::string> told_at_start(const std::string& more, const std::string& body = "") {
  const Scene scene = parse_scene(
      "[body.b]\nshape = \"box\"\ncells = [3, 3, 3]\nsize = [0.1, 0.1, 0.1]\n" + body + more,
      "b.toml", {});
  BuildReport report;
  build_model(scene, &report);
  return report.warnings;
}

void expect_one(const std::vector<std::string>& said, const std::string& part) {
  ASSERT_EQ(said.size(), 1u) << part;
  EXPECT_NE(said[0].find(part), std::string::npos) << said[0];
}

TEST(StartWarnings, ABodyInsideAnObstacleOrBelowTheGround) {
  expect_one(told_at_start("[obstacle.o]\nshape = \"box\"\nsize = [1, 1, 1]\ncenter = [0, 0, 0]\n"),
             "body b starts inside obstacle o: 64 of its 64 nodes");
  expect_one(told_at_start("[ground]\npoint = [0, 10, 0]\n"), "body b starts below the ground");
  EXPECT_TRUE(told_at_start("[ground]\npoint = [0, -0.05, 0]\n").empty());  // lies on it
}

TEST(StartWarnings, BodiesInTheSamePlace) {
  const std::string c =
      "[contact]\n[body.c]\nshape = \"box\"\ncells = [3, 3, 3]\nsize = [0.1, 0.1, 0.1]\n";
  expect_one(told_at_start(c), "overlap at the start");
  EXPECT_TRUE(told_at_start(c + "position = [0.1, 0, 0]\n").empty());  // flush
  EXPECT_TRUE(told_at_start(c + "position = [0.3, 0, 0]\n").empty());
}

TEST(StartWarnings, PinsThatJump) {
  const std::string pin = "[pin.a]\nselect = { side = \"-x\" }\npath = ";
  expect_one(told_at_start(pin + "[{ time = 0 }, { time = 1e-9, move = [1, 0, 0] }]\n"),
             "pin a jumps at 0 s: it moves 1 m in 1e-09 s");
  expect_one(told_at_start(pin + "[{ time = 0, move = [0.1, 0, 0] }]\n"),
             "pin a jumps at the start");
  EXPECT_TRUE(told_at_start(pin + "[{ time = 0 }, { time = 1, move = [1, 0, 0] }]\n").empty());
}

TEST(StartWarnings, DistancesThatDoNotHold) {
  const std::string d =
      "[distance.d]\nselect = { nearest = [0.05, 0.05, 0.05] }\n"
      "point = [0.05, 0.25, 0.05]\nlength = ";
  const std::string pin = "[pin.a]\nselect = { all = true }\n";
  expect_one(told_at_start(pin + d + "0.1\n"), "distance d cannot hold");
  expect_one(told_at_start(d + "0.1\n"), "distance d jumps at the start");
  EXPECT_TRUE(told_at_start(pin + d + "0.2\n").empty());
  EXPECT_TRUE(told_at_start(pin + d + "0.3\nrope = true\n").empty());
}

}  // namespace
}  // namespace sinew
