// The output of a session: frames to draw, a status in numbers, and the adjustable values.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sinew/forces/terms.h"
#include "sinew/live/command.h"
#include "sinew/live/quantity.h"
#include "sinew/sim/run_counters.h"

namespace sinew::live {

struct Frame {
  std::uint32_t revision = 0;  // of the Topology that it belongs to
  std::uint64_t number = 0;    // counts up with every frame published
  double time = 0.0;           // simulated [s]
  Quantity quantity = Quantity::displacement;
  std::vector<float> position;        // [m] (3 a node shown)
  std::vector<float> value;           // of the quantity (nodes shown)
  std::vector<float> compared;        // positions of the compared body [m]; empty: none
  std::vector<std::uint8_t> contact;  // 1 for nodes in contact; empty: none is
};

// A hand that holds a grab.
struct HandStatus {
  int hand = 0;
  Vec3 at = Vec3::Zero();      // current position of the grabbed patch [m]
  Vec3 target = Vec3::Zero();  // target of the hand [m]
  Vec3 force = Vec3::Zero();   // on the tissue [N]
};

// A rigid object that pushes: an obstacle of the scene, or the sphere of the ball tool.
struct SphereStatus {
  Vec3 center = Vec3::Zero();    // [m]
  double radius = 0.0;           // [m]
  Vec3 force = Vec3::Zero();     // of the bodies on it [N]
  std::int64_t contacts = 0;     // nodes in a soft one, contacts with a hard one
  Mat3 turn = Mat3::Identity();  // rotation: its own axes in the world, as columns
};

// Distance of the compared body from the first.
struct Distance {
  double largest = 0.0, mean = 0.0;  // over the nodes of the bodies [m]
};

struct Status {
  std::uint32_t revision = 0;
  std::uint32_t changes = 0;  // counts changes of values, see Parameters
  bool running = false;
  double time = 0.0;         // simulated [s]
  std::int64_t step = 0;     // steps taken
  double dt = 0.0;           // current step [s]
  double stable_step = 0.0;  // longest explicit step at the last estimate [s]; infinity: any
  StepperKind stepper = StepperKind::verlet;
  std::string reason;  // of the choice with stepper = "auto"
  double time_scale = 1.0;
  double rate = 0.0;      // simulated seconds per second, over the last half second [-]; paused 0
  double capacity = 0.0;  // the same without waiting for the clock [-]
  double ms_per_step = 0.0;      // of wall time
  double steps_per_frame = 0.0;  // of 1/60 s simulated
  double newton_per_step = 0.0;  // implicit steps
  double products_per_newton = 0.0;
  std::string limit;  // reason why the time scale is not reached; empty: it is
  Energies energy;
  double volume_ratio = 1.0;                     // of all bodies [-]
  double max_stretch = 0.0, max_compress = 0.0;  // [-]
  RunCounters counters;                          // since the start, or since a value was changed
  std::int64_t inverted_tets = 0;
  std::vector<HandStatus> hands;
  std::vector<Vec3> probes;             // their displacements [m], in the scene's order
  std::vector<SphereStatus> obstacles;  // in the scene's order
  std::optional<SphereStatus> ball;
  std::optional<Distance> distance;         // if bodies are compared
  bool can_undo = false, can_redo = false;  // cuts
  double cut_area = 0.0;                    // of all cuts, one side [m2]
  std::int64_t pieces = 0;                  // of the bodies, after the last cut; 0: nothing was cut
  std::string error;         // reason for the stop, or for the last refusal; empty: none
  std::uint32_t errors = 0;  // counts errors, so that a repeated one is noticed
};

// The current values that may be changed during the simulation.
struct Parameters {
  struct Part {
    std::string body;
    std::string region;  // empty: tets that no region covers, or the whole body
    Material material;
  };
  std::vector<Part> parts;
  Vec3 gravity = Vec3::Zero();  // [m/s2]
  std::string stepper;          // as requested
  double dt = 0.0;              // [s]; 0: auto
  bool has_ground = false;
  Vec3 ground_point = Vec3::Zero();
  Vec3 ground_normal = Vec3::UnitY();
  std::string scene, title, look_for;
  std::uint32_t opened = 0;  // counts scenes loaded, from 1
  std::vector<std::string> probes;
  struct Rigid {
    std::string name;
    double radius = 0.0;           // of a ball around it [m]; 0 for a plane
    std::string shape = "sphere";  // as in scenes
    // The surface to draw, in its own axes; empty for a sphere and a plane, which the page draws.
    std::vector<Vec3> vertices;       // [m]
    std::vector<Vec3> normals;        // outwards (vertices); empty: those of the triangles
    std::vector<Triangle> triangles;  // indices into vertices
  };
  std::vector<Rigid> obstacles;
  std::string compare;  // law of the compared body, or empty
  Cut cut;
  bool springs_shown = false;
  std::int64_t nodes = 0, tets = 0, springs = 0;
  double mass = 0.0;     // [kg]
  std::string document;  // the scene as TOML with the current values
};

}  // namespace sinew::live
