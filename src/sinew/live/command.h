// The commands of a session. Values are checked when a command is applied (apply_command.cpp).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <variant>

#include "sinew/base/vec.h"
#include "sinew/live/quantity.h"
#include "sinew/scene/scene.h"

namespace sinew::live {

struct Play {
  bool running = true;
};

// Ends a step that takes long, and pauses.
struct Cancel {};

// Takes one step, or the steps to the end of the frame; pauses.
struct Advance {
  bool frame = false;
};

// Returns to the start of the scene with the current values.
struct Reset {};

// Replaces the scene by another one; pauses.
struct Load {
  Scene scene;
};

// The same for a scene that takes long to read. A Runner opens it on another thread.
struct Open {
  std::function<Scene()> scene;  // may throw Error
};

// A material key of [body.NAME]: young, poisson, density, damping_ratio ... Without a body: every
// body; without a region: the whole body, including regions with a value of their own.
struct SetMaterial {
  std::string body;
  std::string region;
  std::string key;
  std::string value;  // a number or a word, as TOML
};

// A key of the scene for its steps: stepper, scheme, dt, substeps, precision, tolerance, safety.
struct SetStepping {
  std::string key;
  std::string value;  // as TOML
};

struct SetGravity {
  Vec3 gravity = Vec3::Zero();  // [m/s2]
};

struct SetTimeScale {
  double scale = 1.0;  // target of simulated seconds per second [-] in [0.001, 100]
};

struct SetQuantity {
  Quantity quantity = Quantity::displacement;
};

// Grabs the tissue around a node of the surface with a spring to the hand.
struct Grab {
  int hand = 0;    // number from 0 to most_hands - 1; a hand that holds something releases it
  Index node = 0;  // of the surface (Topology)
  Vec3 point = Vec3::Zero();  // position of the hand [m]
  double radius = 0.0;        // of the grabbed patch [m]; 0: a few of the mesh's edges
};

struct Drag {
  int hand = 0;
  Vec3 point = Vec3::Zero();  // current position of the hand [m]
};

struct Release {
  int hand = 0;
};

inline constexpr int most_hands = 16;

// The ball tool: a rigid, frictionless sphere that pushes. It reaches its target within a frame or,
// from far away, at a speed that tissue can follow.
struct MoveBall {
  Vec3 point = Vec3::Zero();  // target of its centre [m]
  double radius = 0.0;        // [m]; 0: unchanged, or a tenth of the body's size
};

struct RemoveBall {};

// The scalpel: a straight edge from heel to tip that cuts as it moves (sim::World::move). With a
// node it begins a stroke, in that node's body, and cuts nothing yet.
struct MoveBlade {
  std::optional<Index> node;                     // of the surface (Topology)
  Vec3 heel = Vec3::Zero(), tip = Vec3::Zero();  // [m]
};

// Ends the stroke.
struct LiftBlade {};

// Take back strokes and other cuts, and make them again.
struct Undo {};
struct Redo {};

// The plane that the view is clipped at.
struct SetCut {
  Cut cut;
};

// Whether springs, and with them all nodes, are shown.
struct SetSprings {
  bool shown = false;
};

// A second body with the same values but this law (scene/laws.h), stepped in lock-step with the
// first from its current state. An empty name removes it.
struct SetCompare {
  std::string law;
};

// Calls `done` on the simulation's thread with the state as a VTU file.
struct SaveState {
  std::function<void(std::string)> done;
};

// Lets go of the hands and the ball, and calls `done` on the simulation's thread with the state as
// of Simulation::save().
struct HandBack {
  std::function<void(std::string)> done;
};

using Command =
    std::variant<Play, Cancel, Advance, Reset, Load, Open, SetMaterial, SetStepping, SetGravity,
                 SetTimeScale, SetQuantity, Grab, Drag, Release, MoveBall, RemoveBall, MoveBlade,
                 LiftBlade, Undo, Redo, SetCut, SetSprings, SetCompare, SaveState, HandBack>;

}  // namespace sinew::live
