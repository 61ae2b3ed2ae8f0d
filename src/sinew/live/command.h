// What a live simulation can be told. Values are checked where they act (Simulation::apply).
#pragma once

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

using Command = std::variant<Play, Advance, Reset, Load, SetMaterial, SetStepping, SetGravity,
                             SetTimeScale, SetQuantity, Grab, Drag, Release>;

}  // namespace sinew::live
