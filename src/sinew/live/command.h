// The commands of a session. Values are checked where they act (apply_command.cpp).
#pragma once

#include <functional>
#include <string>
#include <variant>

#include "sinew/base/vec.h"
#include "sinew/live/quantity.h"
#include "sinew/scene/scene.h"

namespace sinew::live {

struct Play {
  bool running = true;
};

// One step, or the steps to the end of the frame; pauses.
struct Advance {
  bool frame = false;
};

// Back to the start of the scene, with the values as they are now.
struct Reset {};

// Another scene in the place of this one; paused.
struct Load {
  Scene scene;
};

// The same, of a scene that takes a while to read: the simulation's thread does it.
struct Open {
  std::function<Scene()> scene;  // may throw Error
};

// A key of [body.NAME] that says what it is made of: young, poisson, density, damping_ratio ...
// Without a body: every body; without a region: the whole body, regions with a value of their own
// included.
struct SetMaterial {
  std::string body;
  std::string region;
  std::string key;
  std::string value;  // a number or a word, as TOML
};

// A key of the scene that says how it is stepped: stepper, scheme, dt, substeps, precision,
// tolerance, safety.
struct SetStepping {
  std::string key;
  std::string value;  // as TOML
};

struct SetGravity {
  Vec3 gravity = Vec3::Zero();  // [m/s2]
};

struct SetTimeScale {
  double scale = 1.0;  // simulated seconds to aim at in a second [-] in [0.001, 100]
};

struct SetQuantity {
  Quantity quantity = Quantity::displacement;
};

// Takes hold of the tissue around a node of the surface: a spring from there to the hand.
struct Grab {
  int hand = 0;               // which, from 0 to most_hands - 1; one that holds something lets go
  Index node = 0;             // of the surface (Topology)
  Vec3 point = Vec3::Zero();  // where the hand is [m]
  double radius = 0.0;        // of what it holds [m]; 0: some of the mesh's edges
};

struct Drag {
  int hand = 0;
  Vec3 point = Vec3::Zero();  // where the hand is now [m]
};

struct Release {
  int hand = 0;
};

inline constexpr int most_hands = 16;

// The ball tool: a rigid, frictionless sphere that pushes. It gets there within a frame or, from
// far, at a speed that tissue can follow.
struct MoveBall {
  Vec3 point = Vec3::Zero();  // where its centre is to be [m]
  double radius = 0.0;        // [m]; 0: as it is, or a tenth of the body's size
};

struct RemoveBall {};

struct SetCut {
  Cut cut;
};

// Whether springs, and with them all nodes, are shown.
struct SetSprings {
  bool shown = false;
};

// Another body with the same values but this law (scene/laws.h), in lock-step with the first, from
// where that one is now. An empty name ends it.
struct SetCompare {
  std::string law;
};

// Calls `done` on the simulation's thread with the state as a VTU file.
struct SaveState {
  std::function<void(std::string)> done;
};

using Command = std::variant<Play, Advance, Reset, Load, Open, SetMaterial, SetStepping, SetGravity,
                             SetTimeScale, SetQuantity, Grab, Drag, Release, MoveBall, RemoveBall,
                             SetCut, SetSprings, SetCompare, SaveState>;

}  // namespace sinew::live
