// A small scene for programs that embed Sinew, and what their mistakes are told. Nothing but the
// public headers, as such programs have.
#pragma once

#include <gtest/gtest.h>
#include <sinew/sinew.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace embed {

inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double inf = std::numeric_limits<double>::infinity();

// Expects `act` to end with an error of this kind whose text has every one of `parts`, the place
// and a remedy among them.
template <typename Act>
void expect_error(sinew::ErrorKind kind, const std::vector<std::string>& parts, const Act& act) {
  try {
    act();
  } catch (const sinew::Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    EXPECT_FALSE(error.remedy().empty()) << error.what();
    for (const std::string& part : parts)
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos)
          << "'" << part << "' is not in: " << error.what();
    return;
  }
  ADD_FAILURE() << "no error; expected one that says '" << (parts.empty() ? "" : parts.front())
                << "'";
}

// The same for a mistake that a simulation takes without harm: it goes on afterwards.
template <typename Act>
void expect_unharmed(sinew::Simulation& simulation, sinew::ErrorKind kind,
                     const std::vector<std::string>& parts, const Act& act) {
  const std::string before = simulation.hash();
  expect_error(kind, parts, act);
  EXPECT_EQ(simulation.hash(), before);
  const double time = simulation.time();
  simulation.step();
  EXPECT_GT(simulation.time(), time);
}

// A box of soft tissue, 10 cm wide, that stands on a pin; a ball 1 cm above it.
inline sinew::SceneBuilder box_scene() {
  sinew::SceneBuilder scene;
  scene.add_body({.name = "box",
                  .shape = "box",
                  .cells = {{2, 2, 2}},
                  .size = {{0.1, 0.1, 0.1}},
                  .position = {{0.05, 0.05, 0.05}},
                  .material = {.young = 5e3}});
  scene.add_pin({.name = "floor", .body = "box", .select = {.side = "-y"}});
  scene.add_obstacle(
      {.name = "ball", .center = {{0.05, 0.13, 0.05}}, .radius = 0.02, .friction = 0.3});
  return scene;
}

inline sinew::Simulation box_simulation() {
  return sinew::Simulation(box_scene());
}

// One tet of side 1, in arrays.
inline sinew::MeshArrays one_tet() {
  return {.nodes = {{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, {0, 0, 0.1}}, .tets = {{0, 1, 2, 3}}};
}

inline sinew::SceneBuilder scene_of(const sinew::MeshArrays& arrays) {
  sinew::SceneBuilder scene;
  scene.add_body({.name = "own", .arrays = arrays});
  return scene;
}

}  // namespace embed
