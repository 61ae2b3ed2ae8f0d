// Calls that cannot be done: each gets its error, and the simulation goes on.
#include <utility>

#include "tests/embed/misuse.h"

namespace embed {
namespace {

using sinew::ErrorKind;
using sinew::Simulation;

TEST(Call, StepsOfNoLengthAreRefused) {
  Simulation s = box_simulation();
  for (const double dt : {0.0, -1e-4, nan, inf, -inf, 11.0, 1e300})
    expect_unharmed(s, ErrorKind::usage, {"dt is ", "above 0 and at most 10 s"},
                    [&] { s.step(dt); });
}

TEST(Call, AStepAboveTheStableOneIsRefused) {
  Simulation s = box_simulation();
  expect_unharmed(s, ErrorKind::unstable, {"the step 0.5 s is above the largest stable one"},
                  [&] { s.step(0.5); });
  s.step(0.5 * s.stable_step());
}

TEST(Call, TimesThatCannotPassAreRefused) {
  Simulation s = box_simulation();
  for (const double seconds : {-1e-3, nan, inf, 3601.0, 1e300})
    expect_unharmed(s, ErrorKind::usage, {"the time to advance is ", "from 0 to 3600 s"},
                    [&] { s.advance(seconds); });
  const std::string before = s.hash();
  EXPECT_TRUE(s.advance(0.0));
  EXPECT_EQ(s.hash(), before);
}

TEST(Call, UnknownNamesAreRefusedWithThoseThereAre) {
  Simulation s = box_simulation();
  expect_unharmed(s, ErrorKind::usage, {"no obstacle 'bal'", "ball"}, [&] { s.obstacle("bal"); });
  expect_unharmed(s, ErrorKind::usage, {"no pin 'wall'", "floor"}, [&] { s.pin("wall"); });
  expect_unharmed(s, ErrorKind::usage, {"no body 'bo'", "box"}, [&] { s.material("bo"); });
  expect_unharmed(s, ErrorKind::usage, {"no region 'core'"}, [&] { s.material("box", "core"); });
  expect_unharmed(s, ErrorKind::usage, {"no obstacle ''"}, [&] { s.obstacle(""); });
}

TEST(Call, PlacesThatAreNoneAreRefused) {
  Simulation s = box_simulation();
  const auto ball = s.obstacle("ball");
  const auto floor = s.pin("floor");
  const auto grab = s.grab(s.nearest_node({0.1, 0.1, 0.1}), 0.02);
  for (const double x : {nan, inf, -inf, 1e300}) {
    const sinew::Point p = {0.0, x, 0.0};
    expect_unharmed(s, ErrorKind::usage, {"the pose is ["}, [&] { s.move(ball, {.center = p}); });
    expect_unharmed(s, ErrorKind::usage, {"the pose is ["}, [&] { s.place(ball, {.center = p}); });
    expect_unharmed(s, ErrorKind::usage, {"the point of the torque"}, [&] { s.wrench(ball, p); });
    expect_unharmed(s, ErrorKind::usage, {"the point of the torque"}, [&] { s.wrench(floor, p); });
    expect_unharmed(s, ErrorKind::usage, {"the move of the pin"},
                    [&] { s.move(floor, {.move = p}); });
    expect_unharmed(s, ErrorKind::usage, {"the turn of the pin"},
                    [&] { s.move(floor, {.turn = p}); });
    expect_unharmed(s, ErrorKind::usage, {"the target of the grab"}, [&] { s.move(grab, p); });
    expect_unharmed(s, ErrorKind::usage, {"gravity is ["}, [&] { s.set_gravity(p); });
    expect_unharmed(s, ErrorKind::usage, {"the place is ["}, [&] { s.nearest_node(p); });
    expect_unharmed(s, ErrorKind::usage, {"the rotation of the pose"}, [&] {
      s.move(ball, {.center = {0, 1, 0}, .rotation = {x == 1e300 ? nan : x, 0, 0, 0}});
    });
  }
  expect_unharmed(s, ErrorKind::usage, {"the rotation of the pose"}, [&] {
    s.move(ball, {.center = {0, 1, 0}, .rotation = {0, 0, 0, 0}});
  });
}

TEST(Call, GrabsOfNothingAreRefused) {
  Simulation s = box_simulation();
  for (const sinew::Index node : {-1, 1000000})
    expect_unharmed(s, ErrorKind::usage, {"there is no node " + std::to_string(node)},
                    [&] { s.grab(node, 0.01); });
  for (const double radius : {0.0, -1.0, nan, inf})
    expect_unharmed(s, ErrorKind::usage, {"the radius of the grab is "},
                    [&] { s.grab(0, radius); });
  EXPECT_TRUE(s.grabs().empty());
}

TEST(Call, HandlesThatNameNothingAreRefused) {
  Simulation s = box_simulation();
  expect_unharmed(s, ErrorKind::usage, {"this handle names no obstacle"},
                  [&] { s.move(sinew::ObstacleHandle{}, {}); });
  expect_unharmed(s, ErrorKind::usage, {"this handle names no pin"},
                  [&] { s.move(sinew::PinHandle{}, {}); });
  expect_unharmed(s, ErrorKind::usage, {"this handle names no grab"},
                  [&] { s.release(sinew::GrabHandle{}); });
  expect_unharmed(s, ErrorKind::usage, {"this handle names no material"},
                  [&] { s.change(sinew::MaterialHandle{}, {}); });
}

TEST(Call, HandlesOfAnotherSimulationAreRefused) {
  Simulation s = box_simulation();
  Simulation other = box_simulation();
  const auto ball = other.obstacle("ball");
  expect_unharmed(s, ErrorKind::usage, {"of another Simulation"}, [&] { s.move(ball, {}); });
  expect_unharmed(s, ErrorKind::usage, {"of another Simulation"}, [&] { s.wrench(ball); });
  expect_unharmed(s, ErrorKind::usage, {"of another Simulation"}, [&] { s.remove(ball); });
  expect_unharmed(s, ErrorKind::usage, {"of another Simulation"},
                  [&] { s.move(other.pin("floor"), {}); });
  expect_unharmed(s, ErrorKind::usage, {"of another Simulation"},
                  [&] { s.change(other.material("box"), {.young = 1e3}); });
  expect_unharmed(s, ErrorKind::usage, {"of another Simulation"},
                  [&] { s.release(other.grab(0, 0.01)); });
  other.wrench(ball);
}

TEST(Call, HandlesOfWhatWasRemovedAreRefused) {
  Simulation s = box_simulation();
  const auto ball = s.obstacle("ball");
  s.remove(ball);
  expect_unharmed(s, ErrorKind::usage, {"the obstacle of this handle was removed"},
                  [&] { s.move(ball, {}); });
  expect_unharmed(s, ErrorKind::usage, {"was removed"}, [&] { s.remove(ball); });
  expect_unharmed(s, ErrorKind::usage, {"no obstacle 'ball'"}, [&] { s.obstacle("ball"); });
  const auto again =
      s.add_obstacle({.name = "ball", .center = {{0.05, 0.2, 0.05}}, .radius = 0.02});
  EXPECT_FALSE(again == ball);
  expect_unharmed(s, ErrorKind::usage, {"was removed"}, [&] { s.depth(ball); });
  EXPECT_EQ(s.depth(again), 0.0);

  const auto grab = s.grab(0, 0.03);
  s.release(grab);
  expect_unharmed(s, ErrorKind::usage, {"the grab of this handle was removed"}, [&] {
    s.move(grab, {0, 0, 0});
  });
}

TEST(Call, ObstaclesThatCannotBeAreNotAdded) {
  Simulation s = box_simulation();
  expect_unharmed(s, ErrorKind::input, {"add_obstacle()", "'radius' in [obstacle.o] is 0"}, [&] {
    s.add_obstacle({.name = "o", .center = {{0, 1, 0}}, .radius = 0.0});
  });
  expect_unharmed(s, ErrorKind::input, {"there is a [obstacle.ball] already"}, [&] {
    s.add_obstacle({.name = "ball", .center = {{0, 1, 0}}, .radius = 0.1});
  });
  expect_unharmed(s, ErrorKind::input, {"nowhere.stl"},
                  [&] { s.add_obstacle({.name = "o", .shape = "mesh", .mesh = "nowhere.stl"}); });
  expect_unharmed(s, ErrorKind::input, {"change(obstacle)", "'radius' in [obstacle.ball]"}, [&] {
    s.change(s.obstacle("ball"), {.center = {{0, 1, 0}}, .radius = -1.0});
  });
  expect_unharmed(s, ErrorKind::usage, {"cannot become 'b'"}, [&] {
    s.change(s.obstacle("ball"), {.name = "b", .center = {{0, 1, 0}}, .radius = 1.0});
  });
  EXPECT_EQ(s.obstacle_names(), std::vector<std::string>{"ball"});
}

TEST(Call, MaterialsThatCannotBeAreRefused) {
  Simulation s = box_simulation();
  const auto box = s.material("box");
  for (const double young : {0.0, -5.0, nan, inf})
    expect_unharmed(s, ErrorKind::input, {"change(material)", "'young' in [body.box]"},
                    [&] { s.change(box, {.young = young}); });
  expect_unharmed(s, ErrorKind::input, {"'law' in [body.box]", "rubber"},
                  [&] { s.change(box, {.law = "rubber"}); });
  expect_unharmed(s, ErrorKind::input, {"livr", "liver"},
                  [&] { s.change(box, {.tissue = "livr"}); });
}

TEST(Call, StatesOfAnotherModelAndOnesThatAreDamagedAreRefused) {
  Simulation s = box_simulation();
  s.step();
  expect_unharmed(s, ErrorKind::input, {"restore()", "is damaged"},
                  [&] { s.restore(sinew::SavedState{}); });
  expect_unharmed(s, ErrorKind::input, {"is damaged"},
                  [&] { s.restore(sinew::SavedState("SINEWST1 and so on, for some bytes")); });
  const std::string good = s.save().bytes();
  for (const std::size_t at : {std::size_t{9}, good.size() / 2, good.size() - 1}) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 1);
    expect_unharmed(s, ErrorKind::input, {"is damaged"},
                    [&] { s.restore(sinew::SavedState(bad)); });
  }
  expect_unharmed(s, ErrorKind::input, {"is damaged"},
                  [&] { s.restore(sinew::SavedState(good.substr(0, good.size() / 2))); });

  sinew::SceneBuilder other = box_scene();
  other.add_body({.name = "more", .shape = "box", .position = {{1, 0, 0}}});
  Simulation another(other);
  expect_unharmed(s, ErrorKind::input, {"restore()", "another scene, mesh or material"},
                  [&] { s.restore(another.save()); });
  const sinew::SavedState before = s.save();
  s.change(s.material("box"), {.young = 6e3});
  expect_unharmed(s, ErrorKind::input, {"another scene, mesh or material"},
                  [&] { s.restore(before); });
}

TEST(Call, ASimulationThatWasMovedFromIsRefusedAndMayBeAssigned) {
  Simulation s = box_simulation();
  const auto ball = s.obstacle("ball");
  const auto positions = s.positions();
  Simulation taken = std::move(s);
  const std::vector<std::string> said = {"this Simulation was moved from"};
  expect_error(ErrorKind::usage, said, [&] { s.step(); });
  expect_error(ErrorKind::usage, said, [&] { s.step(1e-4); });
  expect_error(ErrorKind::usage, said, [&] { s.advance(0.1); });
  expect_error(ErrorKind::usage, said, [&] { s.time(); });
  expect_error(ErrorKind::usage, said, [&] { s.positions(); });
  expect_error(ErrorKind::usage, said, [&] { s.obstacle("ball"); });
  expect_error(ErrorKind::usage, said, [&] { s.move(ball, {}); });
  expect_error(ErrorKind::usage, said, [&] { s.grab(0, 0.1); });
  expect_error(ErrorKind::usage, said, [&] { s.save(); });
  expect_error(ErrorKind::usage, said, [&] { s.restore(taken.save()); });
  expect_error(ErrorKind::usage, said, [&] { s.hash(); });
  expect_error(ErrorKind::usage, said, [&] { s.take_events(); });
  s.interrupt();  // does nothing

  EXPECT_EQ(taken.positions().data(), positions.data());  // spans and handles moved along
  taken.move(ball, {.center = {0.05, 0.14, 0.05}});
  taken.step();
  s = box_simulation();
  s.step();
  s = std::move(taken);
  s.wrench(ball);
}

// The ball is pressed through the box: nothing diverges, or an error says so and the box goes on.
TEST(Call, AToolThatJumpsIntoTheTissueLeavesItUsable) {
  Simulation s = box_simulation();
  const auto ball = s.obstacle("ball");
  s.place(ball, {.center = {0.05, 0.06, 0.05}});
  for (int i = 0; i < 20; ++i) {
    try {
      s.advance(1e-3);
    } catch (const sinew::Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::diverged) << error.what();
    }
  }
  s.place(ball, {.center = {0.05, 5.0, 0.05}});
  s.advance(0.01);
  for (const sinew::Point& p : s.positions())
    for (const double x : p) ASSERT_TRUE(std::isfinite(x));
}

// A step that is allowed to be unstable: the state that was good comes back, an event tells.
TEST(Call, AStateThatDivergesIsPutBack) {
  sinew::SceneBuilder scene = box_scene();
  scene.set_stepping({.dt = 0.05, .allow_unstable = true});
  Simulation s(scene);
  const sinew::SavedState start = s.save();
  expect_error(ErrorKind::diverged, {"dt"}, [&] { s.advance(1000.0); });
  for (const sinew::Point& p : s.positions())
    for (const double x : p) ASSERT_TRUE(std::isfinite(x) && std::abs(x) < 1e9);
  bool told = false;
  for (const sinew::Event& event : s.take_events())
    told = told || event.kind == sinew::EventKind::diverged;
  EXPECT_TRUE(told);
  EXPECT_TRUE(s.take_events().empty());
  s.restore(start);
  s.step(1e-4);
}

}  // namespace
}  // namespace embed
