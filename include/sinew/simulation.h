// A simulation of soft bodies that a program owns and steps.
//
//   auto simulation = sinew::Simulation::from_file("liver.toml");
//   const auto tool = simulation.obstacle("tool");
//   for (int ms = 0; ms < 1000; ++ms) {
//     simulation.move(tool, {.center = {0.0, 0.2 - 1e-4 * ms, 0.0}});
//     simulation.advance(1e-3);
//     const sinew::Wrench w = simulation.wrench(tool);
//   }
//
// Errors. Every function throws sinew::Error where it cannot do what is asked, and then leaves the
// simulation as it was: usage for a wrong call (a value that is not finite, an unknown name, the
// handle of a removed thing or of another simulation, a simulation that was moved from), input for
// a scene or a value in it, unstable for a step above the stable one, io for a file. The one
// exception is Error(diverged): the state became infinite. The simulation then returns to the state
// at the end of an earlier frame, at most a frame (1/fps) and 1/60 s before. Nothing is printed.
//
// Threads. A Simulation may be used by one thread at a time, and by a different thread each time;
// several may be used by several threads at once. interrupt() alone may be called at any time. A
// Simulation shares nothing with another one but the worker threads of TBB.
//
// Results are the same bits for every number of threads, and those of `sinew run`.
//
// Lifetime. A span stays valid until the next call of a function that is not const, and no longer
// than the Simulation, which may be moved meanwhile. Handles are plain values: they stay valid
// until the thing is removed, and in a Simulation that was moved.
#pragma once

#include <sinew/error.h>
#include <sinew/export.h>
#include <sinew/scene_builder.h>
#include <sinew/types.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sinew {

namespace sim {
class World;
}

// Names a thing of one simulation. A default one names nothing.
template <typename Kind>
class Handle {
 public:
  Handle() = default;
  friend bool operator==(const Handle&, const Handle&) = default;

 private:
  friend class sim::World;
  Handle(std::uint64_t simulation, std::uint64_t id) : simulation_(simulation), id_(id) {}
  std::uint64_t simulation_ = 0;  // its number in this process; 0: none
  std::uint64_t id_ = 0;
};
using ObstacleHandle = Handle<struct ObstacleKind>;
using PinHandle = Handle<struct PinKind>;
using GrabHandle = Handle<struct GrabKind>;
using MaterialHandle = Handle<struct MaterialKind>;

struct SimulationOptions {
  // Threads that step it, from 1 to 1024. 0: it runs in the TBB arena of the thread that calls.
  int threads = 0;
  // Where relative paths of meshes start, for texts and builders; empty: the current folder.
  std::filesystem::path base = {};
  // Values in place of the scene's, as the command line's --set: "body.liver.young=5e3".
  std::vector<std::string> set = {};
};

struct BodyInfo {
  std::string name;
  IndexRange nodes;          // in positions()
  IndexRange tets;           // in tets()
  double mass = 0.0;         // [kg]
  double rest_volume = 0.0;  // [m3]
};

struct ProbeValue {
  std::string name;
  Point position = {0.0, 0.0, 0.0};      // mean of its nodes [m]
  Point displacement = {0.0, 0.0, 0.0};  // of that since the rest shape [m]
};

enum class EventKind {
  inverted,         // there are inverted tets at the end of a frame; count: how many
  diverged,         // the state is that at the end of an earlier frame again
  stepper_changed,  // text: the stepper, and why
  step_shortened,   // the body became stiffer: count: how many times within a frame
};

// What a host should know of and did not ask for.
struct Event {
  EventKind kind = EventKind::inverted;
  double time = 0.0;  // of the simulation [s]
  std::int64_t count = 0;
  std::string text;
};

// All that decides how a simulation goes on, in memory. bytes() may be stored and read by the same
// version of Sinew.
class SINEW_API SavedState {
 public:
  SavedState() = default;
  explicit SavedState(std::string bytes) : bytes_(std::move(bytes)) {}
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

class SINEW_API Simulation {
 public:
  // Reads a scene file (docs/scene-format.md). Error(io) where it cannot be read, Error(input) with
  // file, line and column for what is wrong in it.
  static Simulation from_file(const std::filesystem::path& file,
                              const SimulationOptions& options = {});
  // The same for a text, named "scene.toml" in messages.
  static Simulation from_text(std::string_view toml, const SimulationOptions& options = {});
  explicit Simulation(const SceneBuilder& scene, const SimulationOptions& options = {});

  // A simulation that was moved from throws Error(usage) in every function but these, and may be
  // assigned to.
  Simulation(Simulation&& other) noexcept;
  Simulation& operator=(Simulation&& other) noexcept;
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;
  ~Simulation();

  // ---- time ----

  // Takes the next step that the scene asks for: of its dt, or of the length that dt = "auto"
  // chooses. With stepper = "static": the rest state at the end of the next frame.
  void step();
  // Takes one step of `dt` > 0 [s], at most 10. Error(unstable) where explicit steps may not be so
  // long; see stable_step().
  void step(double dt);
  // Takes steps until `seconds` more have passed, from 0 to 3600: to the rounded bit where dt =
  // "auto"; with a given dt the whole steps that come nearest, and what is left counts in the next
  // call. True: done; false: interrupted.
  bool advance(double seconds);
  // Lets a step() or advance() of another thread end after the step under way, or the next one
  // where none is. The one function that may be called from any thread at any time.
  void interrupt() noexcept;

  double time() const;         // [s]
  std::int64_t steps() const;  // taken
  double last_step() const;    // [s]; 0 before the first
  // The longest explicit step that is stable, when last looked at [s]; infinite for other steppers.
  double stable_step() const;
  std::string stepper() const;  // verlet, implicit, static

  // ---- arrays, without a copy ----

  std::span<const Point> positions() const;       // [m] (nodes)
  std::span<const Point> rest_positions() const;  // [m] (nodes)
  // The way of the last step over its length [m/s] (nodes).
  std::span<const Point> velocities() const;
  // The force on each node [N] (nodes). At the positions as they are: of the material, and on free
  // nodes of gravity, loads, soft obstacles and grabs. Of the last step, 0 before it and after a
  // change that builds the model anew: of contacts and of the ground. Not of limits, ropes and
  // rods. Computed by the first call after a change, which costs about as much as a step.
  std::span<const Point> forces() const;
  std::span<const double> masses() const;        // [kg] (nodes)
  std::span<const Tet> tets() const;             // node ids (tets)
  std::span<const Triangle> surface() const;     // node ids, of all bodies
  std::span<const BodyInfo> bodies() const;      // in the scene's order
  Index inverted_tets() const;                   // tets of negative volume now
  Index nearest_node(const Point& place) const;  // of the surface
  std::vector<ProbeValue> probes() const;

  // ---- obstacles ----

  // The obstacle of that name. Error(usage) with the names there are.
  ObstacleHandle obstacle(std::string_view name) const;
  std::vector<std::string> obstacle_names() const;
  // Adds an obstacle between steps; times of a path are those of the simulation. Error(input) as
  // for a scene; a name may not be one that is there. Builds the model anew: as long as loading.
  ObstacleHandle add_obstacle(const ObstacleDescription& obstacle);
  // Puts another one in its place; the handle stays. As long as add_obstacle.
  void change(ObstacleHandle obstacle, const ObstacleDescription& description);
  void remove(ObstacleHandle obstacle);
  // From where it is to `pose`, straight and at constant speed, over the next step() or advance();
  // then it stays. Takes the place of the path of the scene.
  void move(ObstacleHandle obstacle, const RigidPose& pose);
  // Puts it there at once, without a speed.
  void place(ObstacleHandle obstacle, const RigidPose& pose);
  RigidPose pose(ObstacleHandle obstacle) const;
  // What the bodies do to it, the torque about `about` [m] or about its centre. Of a hard obstacle
  // the mean over the last step, 0 before it; of a soft one as the positions are.
  Wrench wrench(ObstacleHandle obstacle, const Point& about) const;
  Wrench wrench(ObstacleHandle obstacle) const;
  // Places that touch it: inside, or outside by less than a thousandth of the longest edge of the
  // bodies' surface. `contacts` is emptied first.
  void contacts(ObstacleHandle obstacle, std::vector<ContactPoint>& contacts) const;
  std::vector<ContactPoint> contacts(ObstacleHandle obstacle) const;
  double depth(ObstacleHandle obstacle) const;  // of the deepest place inside [m]; 0: none

  // ---- pins ----

  PinHandle pin(std::string_view name) const;
  std::vector<std::string> pin_names() const;
  // To `motion` since the start, as an obstacle is moved.
  void move(PinHandle pin, const RigidMotion& motion);
  RigidMotion motion(PinHandle pin) const;
  // What its nodes load the pin with: their forces() and their weight; the torque about `about`
  // [m].
  Wrench wrench(PinHandle pin, const Point& about) const;

  // ---- grabs: springs that pull a patch of tissue ----

  // Holds the nodes of the node's body within `radius` [m] > 0 of it, where they are; as stiff as
  // the tissue under it.
  GrabHandle grab(Index node, double radius);
  // Where the middle of the patch is to be [m]; at once.
  void move(GrabHandle grab, const Point& target);
  Point target(GrabHandle grab) const;
  Point force(GrabHandle grab) const;  // that it pulls the tissue with [N]
  void release(GrabHandle grab);
  std::vector<GrabHandle> grabs() const;  // those that hold something

  // ---- what else may change between steps ----

  // The material of a body, or of one of its regions.
  MaterialHandle material(std::string_view body, std::string_view region = {}) const;
  // Gives the values that are there; the others stay. Error(input) for one that cannot be.
  // Builds the model anew: as long as loading. Positions stay.
  void change(MaterialHandle material, const MaterialDescription& description);
  void set_gravity(const Point& gravity);  // [m/s2], of at most 1e4
  Point gravity() const;

  // ---- states ----

  SavedState save() const;
  // Goes on from a state of this simulation or of another of the same scene: the same bits as
  // without a break. Error(input) for a state of another model, or that is damaged.
  void restore(const SavedState& state);
  // 16 hexadecimal digits over positions, velocities, time and steps: those `sinew run` prints.
  std::string hash() const;

  // ---- what happened ----

  // Takes the events since the last call; at most 1000 are kept, the newest.
  std::vector<Event> take_events();
  // What is worth knowing about the scene: repaired meshes, sizes that look wrong, overlaps.
  std::span<const std::string> warnings() const;

 private:
  friend class sim::World;
  explicit Simulation(std::unique_ptr<sim::World> world);
  sim::World& any_world() const;
  sim::World& world() const;
  std::unique_ptr<sim::World> world_;
};

}  // namespace sinew
